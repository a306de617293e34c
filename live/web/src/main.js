// Live page: the engine in a worker, the design, and the panels that show the results.
import { packed, unpacked } from "./address.js";
import { h } from "./dom.js";
import { Editor } from "./editor.js";
import { Engine } from "./engine.js";
import { Form } from "./form.js";
import { layOut } from "./frame.js";
import { Head } from "./head.js";
import { Notice } from "./notice.js";
import { CurvePanel } from "./panels/curve.js";
import { FarFieldPanel } from "./panels/far_field.js";
import { Ledger } from "./panels/ledger.js";
import { MapPanel } from "./panels/map.js";
import { PhotometryPanel } from "./panels/photometry.js";
import { PlanPanel } from "./panels/plan.js";
import { RayPanel } from "./panels/ray.js";
import { Readout } from "./panels/readout.js";
import { ScenePanel } from "./panels/scene.js";
import { Session } from "./session.js";
import { startReport } from "../../../report/page/web/src/report.js";
import { addThemeSwitch } from "../../../report/page/web/src/theme.js";

const FIRST = { kind: "hexagonal_icc", incidence_deg: 12, azimuth_deg: 30 }; // state of a page without a design

/** Creates the panel with two tabs: the form and the text of the design. Arrow keys switch between tabs. */
function designPanel(form, editor) {
  const pages = {
    form: h("div", { id: "live-form", role: "tabpanel", "aria-labelledby": "live-tab-form" }, form.node),
    text: h("div", { id: "live-text", role: "tabpanel", "aria-labelledby": "live-tab-text" }, editor.node),
  };
  const tab = (name, text) =>
    h("button", { type: "button", role: "tab", id: `live-tab-${name}`, "aria-controls": `live-${name}`, onclick: () => choose(name) }, text);
  const tabs = { form: tab("form", "Form"), text: tab("text", "TOML") };
  const choose = (name) => {
    for (const [other, page] of Object.entries(pages)) {
      page.hidden = other !== name;
      tabs[other].setAttribute("aria-selected", String(other === name));
      tabs[other].tabIndex = other === name ? 0 : -1;
    }
  };
  const press = (event) => {
    if (!/^Arrow(Left|Right)$/.test(event.key)) return;
    const other = pages.form.hidden ? "form" : "text";
    choose(other);
    tabs[other].focus();
  };
  choose("form");
  const list = h("div", { class: "tabs", role: "tablist", onkeydown: press }, ...Object.values(tabs));
  return { node: h("aside", { class: "design", "aria-label": "Design" }, list, ...Object.values(pages)), choose };
}

class LivePage {
  constructor(root, start) {
    this.root = root;
    this.start = start;
    this.isEmbedded = Boolean(start.embedded);
    this.engine = new Engine();
    this.session = new Session(this.engine);
    const session = this.session;
    this.ledger = new Ledger(session);
    this.readout = new Readout(session, this.ledger);
    this.notice = new Notice(session);
    this.form = new Form(session, () => this.design.choose("text"));
    this.editor = new Editor(session);
    this.design = designPanel(this.form, this.editor);
    this.head = new Head(session, { isEmbedded: this.isEmbedded, version: start.version });
    this.photometry = new PhotometryPanel(session);
    this.map = new MapPanel(session);
    this.panels = [new ScenePanel(session), new PlanPanel(session), new CurvePanel(session), this.map, new RayPanel(session), new FarFieldPanel(session)];
    layOut(root, {
      header: this.head.node,
      design: this.design.node,
      notice: this.notice.node,
      readout: this.readout.node,
      number: this.readout.small,
      stage: this.panels.slice(0, 4).map(({ node }) => node),
      more: [...this.panels.slice(4).map(({ node }) => node), this.photometry.node],
      isEmbedded: this.isEmbedded,
    });
  }

  async run() {
    for (const shown of [...this.panels, this.readout, this.notice, this.editor]) shown.start();
    this.engine.failed = (error) => this.notice.refuse({ text: `The engine does not start: ${error.message}` });
    try {
      await this.engine.start();
    } catch (error) {
      this.engine.failed(error);
      return;
    }
    const { answers } = await this.engine.ask({ asks: [{ ask: "about" }, { ask: "form" }, { ask: "standards" }] });
    const [about, form, standards] = answers;
    this.ledger.start(about.accounts);
    this.form.start(form.groups, about.materials || []);
    this.photometry.start(standards.standards);
    this.head.start(about.kinds, () => this.address());
    await this.begin();
    for (const event of ["rest", "state", "pins"]) this.session.on(event, () => this.remember());
    this.session.on("answer", ({ stamp }) => this.ready(stamp));
    this.session.on("refused", ({ text }) => text != null && this.design.choose("text"));
    window.addEventListener("hashchange", () => this.restore());
  }

  /** Opens the design in the address, or the design of the page, or a template. */
  async begin() {
    const { incidence_deg, azimuth_deg } = FIRST;
    this.session.direction = { incidence_deg, azimuth_deg };
    this.readout.point(this.session.direction);
    if (await this.restore()) return;
    if (this.start.toml != null) {
      this.session.open(this.start.toml, this.start.source);
      return;
    }
    const { answers } = await this.engine.ask({ asks: [{ ask: "template", kind: FIRST.kind, extent: "infinite" }] });
    this.session.open(answers[0].toml, "design.toml");
  }

  ready(stamp) {
    requestAnimationFrame(() => {
      this.session.measure.shown("point", stamp);
      this.root.dataset.ready = "yes";
    });
  }

  // --- the state in the address

  state() {
    const { base, direction, spot, curve, rest } = this.session;
    return {
      toml: base.toml,
      source: base.source,
      direction,
      spot,
      range_deg: curve.half_range_deg,
      programme: this.photometry.state(),
      pins: rest.pins.map(({ toml, source, title }) => ({ toml, source, title })),
    };
  }

  async address() {
    return `${location.href.replace(/#.*$/, "")}${await packed(this.state())}`;
  }

  async remember() {
    if (this.isEmbedded || !this.session.base) return;
    const address = await this.address();
    this.own = address.slice(address.indexOf("#"));
    history.replaceState(null, "", this.own);
  }

  async restore() {
    if (this.isEmbedded || location.hash.length < 3 || location.hash === this.own) return false;
    const state = await unpacked(location.hash);
    if (!state || typeof state.toml !== "string") return false;
    const { session } = this;
    Object.assign(session.direction, state.direction);
    this.readout.point(session.direction);
    session.spot = state.spot || null;
    session.rest.pins = (state.pins || []).slice(0, 4).map((pin) => ({ ...pin, pass: null }));
    if (state.range_deg) this.panels[2].reach(state.range_deg);
    this.photometry.restore(state.programme);
    session.open(state.toml, state.source || "design.toml");
    return true;
  }
}

/** Starts the live page. It may also be a section of a report, whose own scripts are run first. */
function start() {
  const page = new LivePage(document.getElementById("live"), JSON.parse(document.getElementById("start").textContent));
  const recolour = () => page.panels.forEach((panel) => panel.recolour && panel.recolour());
  if (document.getElementById("page-data")) startReport(recolour);
  else addThemeSwitch(recolour);
  window.retraceLive = page.session;
  page.run();
}

start();
