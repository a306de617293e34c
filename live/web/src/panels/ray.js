// Shows light paths as text: the list of all paths, and the interfaces of one path with their angles and critical
// angles.
import { h } from "../dom.js";
import { panel } from "../frame.js";
import { percent, short, words } from "../units.js";
import { colourOf } from "./scene.js";

const MARKS = { total_reflection: "good", reflection: "open", exits: "bad", escapes: "bad", leaves_side: "bad", ends: "bad", leaves: "good" };

const EVENTS = {
  enters: "enters",
  total_reflection: "total reflection",
  reflection: "partial reflection",
  leaves: "leaves",
  exits: "leaves at the back",
  enters_again: "enters again",
  leaves_side: "leaves at a side",
  escapes: "is lost behind the part",
  ends: "ends",
};

/** Draws a scale from 0 to 90 degrees with the angle of incidence and the range of total reflection. */
function gauge({ incidence_deg, critical_deg, event }) {
  if (incidence_deg == null) return "";
  const share = (deg) => `${((100 * deg) / 90).toFixed(1)}%`;
  return h(
    "span",
    { class: "gauge", "aria-hidden": "true" },
    critical_deg == null ? null : h("i", { class: "total", style: `left: ${share(critical_deg)}` }),
    h("b", { class: MARKS[event] || "", style: `left: ${share(incidence_deg)}` }),
  );
}

export class RayPanel {
  constructor(session) {
    this.session = session;
    this.chosen = 0; // index of the chosen path; -1 means all paths
    this.listed = "";
    this.list = h("fieldset", { class: "paths" });
    this.rows = h("tbody", {});
    const heads = [["", ""], ["Interface", ""], ["Angle", "n"], ["Critical", "n"], ["0 – 90°", "g"], ["Power", "n"]];
    const table = h(
      "table",
      {},
      h("thead", {}, h("tr", {}, ...heads.map(([text, style]) => h("th", { scope: "col", class: style }, text)))),
      this.rows,
    );
    this.node = panel(
      "ray",
      "Ray, interface by interface",
      {},
      this.list,
      h("div", { class: "table-box", tabindex: "0", role: "region", "aria-label": "Interfaces of the ray" }, table),
    );
  }

  start() {
    this.session.on("answer", () => this.show());
  }

  choose(index) {
    this.chosen = index;
    this.tell();
    this.session.tell("path", index);
  }

  show() {
    const { paths } = this.session;
    if (this.chosen >= paths.length) this.choose(0);
    this.listPaths();
    this.tell();
  }

  /** Lists the paths to choose from. The list is not rebuilt if only the angles of the paths have changed. */
  listPaths() {
    const { paths, spot } = this.session;
    const texts = paths.map((path) => (path.share == null ? path.fate : `${path.fate} · ${percent(path.share, 0)}`));
    const listed = JSON.stringify([texts, paths.map(colourOf), Boolean(spot)]);
    if (listed === this.listed) return;
    this.listed = listed;
    this.list.replaceChildren(
      h("legend", {}, spot ? "Ray at the selected spot" : "Light paths, the most frequent first"),
      ...texts.map((text, index) => this.choice(index, text, colourOf(paths[index], index))),
      ...(paths.length > 1 ? [this.choice(-1, "all paths", null)] : []),
    );
  }

  choice(index, text, colour) {
    const input = h("input", { type: "radio", name: "live-path", value: index, onchange: () => this.choose(index) });
    input.checked = index === this.chosen;
    const swatch = h("span", { class: "swatch", style: colour ? `background: var(${colour})` : "visibility: hidden" });
    return h("label", {}, input, swatch, h("span", {}, text));
  }

  tell() {
    const path = this.session.paths[Math.max(0, this.chosen)];
    this.rows.replaceChildren(...(path ? path.steps.map((step, k) => this.row(step, k)) : []));
  }

  row(step, k) {
    const degrees = (deg) => (deg == null ? "" : `${deg.toFixed(1)}°`);
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, k + 1),
      h("td", { title: step.at_mm ? `at (${step.at_mm.map((c) => short(c)).join(", ")}) mm` : null }, EVENTS[step.event] || words(step.event), step.role && h("span", { class: "role" }, words(step.role))),
      h("td", { class: "n" }, degrees(step.incidence_deg)),
      h("td", { class: "n" }, degrees(step.critical_deg)),
      h("td", { class: "g" }, gauge(step)),
      h("td", { class: "n" }, percent(step.power, 1)),
    );
  }
}
