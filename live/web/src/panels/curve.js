// Plot of RRE against incidence: the current design, pinned designs, and the current incidence.
import uPlot from "uplot";
import { h } from "../dom.js";
import { button, panel } from "../frame.js";
import { percent, short } from "../units.js";
import { CURVE_AXES, curveSvg, save, curveCsv } from "../files.js";
import { differenceText } from "../pins.js";
import { aligned, axis } from "../../../../report/page/web/src/charts.js";
import { colour } from "../../../../report/page/web/src/theme.js";

export const GHOSTS = ["--curve-1", "--curve-2", "--curve-3", "--curve-4"];
const RANGES_DEG = [30, 60, 85];

/**
 * Converts a curve for the chart library.
 * \param pass computed curve; may be null
 */
function seriesOf(label, pass) {
  const rows = pass ? pass.rows() : [];
  return { label, x: rows.map((row) => row.x), y: rows.map((row) => 100 * row.rre) };
}

/** Returns the value of a curve at an incidence by linear interpolation, or nothing outside the curve. */
function valueAt(pass, incidence) {
  const rows = pass ? pass.rows() : [];
  const k = rows.findIndex(({ x }) => x >= incidence);
  if (k < 0 || (k === 0 && rows[0].x > incidence)) return null;
  if (k === 0 || rows[k].x === incidence) return rows[k].rre;
  const share = (incidence - rows[k - 1].x) / (rows[k].x - rows[k - 1].x);
  return rows[k - 1].rre + share * (rows[k].rre - rows[k - 1].rre);
}

export class CurvePanel {
  constructor(session) {
    this.session = session;
    this.element = h("div", {
      class: "picture plot curve-view",
      tabindex: "0",
      role: "application",
      "aria-label": "RRE against incidence. Left and right arrows change the selected incidence, with shift by five degrees.",
    });
    this.range = h(
      "select",
      { "aria-label": "Range of incidence", onchange: () => this.reach(Number(this.range.value)) },
      ...RANGES_DEG.map((deg) => h("option", { value: deg, selected: deg === 60 }, `±${deg}°`)),
    );
    this.spoken = h("p", { class: "spoken", "aria-live": "polite" });
    this.legend = h("ul", { class: "pins", "aria-label": "Curves" });
    const tools = [this.range, button("CSV", () => this.save("csv")), button("SVG", () => this.save("svg"))];
    this.node = panel("curve", "RRE against incidence", { tools }, this.element, this.legend, this.spoken);
  }

  start() {
    this.plot = new uPlot(this.options(), [[0], [null], [null], [null], [null], [null]], this.element);
    new ResizeObserver(() => this.fit()).observe(this.element);
    this.fit();
    this.point();
    this.session.on("curve", (pass) => this.show(pass));
    this.session.on("pins", () => (this.tellPins(), this.show(this.session.curve.shown)));
    this.session.on("direction", () => this.plot.redraw(false, false));
    this.session.on("answer", () => this.plot.redraw(false, false));
    this.session.on("rested", () => this.tellPins());
    this.session.on("design", () => this.tellPins());
    this.element.addEventListener("keydown", (event) => this.press(event));
  }

  options() {
    const line = (label, name, more) => ({ label, stroke: () => colour(name), width: 2, spanGaps: true, points: { show: false }, ...more });
    return {
      width: 300,
      height: 200,
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false }, x: true, y: false },
      scales: { x: { time: false, range: () => this.reachOf() }, y: { range: () => [0, 100] } },
      axes: [axis(CURVE_AXES.x, 40), axis(CURVE_AXES.y, 44)],
      series: [{}, ...GHOSTS.map((name) => line("pinned", name, { dash: [5, 4], width: 1.5 })), line("this design", "--curve-0", { width: 2.5 })],
      hooks: { draw: [(plot) => this.drawPointer(plot)] },
    };
  }

  recolour() {
    this.plot.redraw(false, true);
  }

  reachOf() {
    const { half_range_deg } = this.session.curve;
    return [-half_range_deg, half_range_deg];
  }

  fit() {
    const width = Math.max(200, Math.floor(this.element.clientWidth));
    const height = Math.max(140, Math.floor(this.element.clientHeight));
    if (width !== this.plot.width || height !== this.plot.height) this.plot.setSize({ width, height });
  }

  /** Clicking or dragging in the plot selects an incidence. */
  point() {
    const { over } = this.plot;
    const at = (event) => {
      const incidence = this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x");
      this.session.look(Math.round(2 * incidence) / 2, this.session.direction.azimuth_deg);
    };
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      this.isHeld = true;
      at(event);
    });
    over.addEventListener("pointermove", (event) => this.isHeld && at(event));
    for (const end of ["pointerup", "pointercancel"]) over.addEventListener(end, () => (this.isHeld = false));
  }

  press(event) {
    const steps = { ArrowLeft: -1, ArrowRight: 1 };
    if (!steps[event.key]) return;
    event.preventDefault();
    const { incidence_deg, azimuth_deg } = this.session.direction;
    this.session.look(incidence_deg + steps[event.key] * (event.shiftKey ? 5 : 1), azimuth_deg);
    const { shown } = this.session.curve;
    const row = shown && shown.rows().find(({ x }) => Math.abs(x - this.session.direction.incidence_deg) < 0.5);
    this.spoken.textContent = `Incidence ${this.session.direction.incidence_deg} degrees${row ? `, RRE ${percent(row.rre, 1)}` : ""}`;
  }

  reach(deg) {
    this.range.value = deg;
    this.session.curve.half_range_deg = deg;
    this.session.map.most_deg = Math.min(80, deg);
    this.session.touch();
  }

  all(pass) {
    const { pins } = this.session.rest;
    return [...GHOSTS.map((_, k) => seriesOf("", pins[k] && pins[k].pass)), seriesOf("", pass)];
  }

  show(pass) {
    if (!pass) return;
    this.plot.setData(aligned(this.all(pass)));
    this.tellPins();
    if (pass.level >= 0) this.session.measure.shown("curve", pass.stamp);
    this.element.dataset.points = pass.rows().length;
  }

  drawPointer(plot) {
    const { incidence_deg } = this.session.direction;
    const { answer } = this.session;
    const context = plot.ctx;
    const x = plot.valToPos(incidence_deg, "x", true);
    const { left, top, width, height } = plot.bbox;
    if (x < left || x > left + width) return;
    const ratio = window.devicePixelRatio || 1;
    context.save();
    context.strokeStyle = colour("--text");
    context.lineWidth = ratio;
    context.setLineDash([3 * ratio, 3 * ratio]);
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    if (answer) {
      context.setLineDash([]);
      context.fillStyle = colour("--curve-0");
      context.strokeStyle = colour("--paper");
      context.lineWidth = 2 * ratio;
      context.beginPath();
      context.arc(x, plot.valToPos(100 * answer.rre, "y", true), 5 * ratio, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
    context.restore();
  }

  /** Lists the designs whose curves are shown: the current design and the pinned designs. */
  listPins() {
    const { pins } = this.session.rest;
    const line = (name) => h("span", { class: "stroke", style: `border-color: var(${name})` });
    this.azimuth = h("span", {});
    this.values = pins.map(() => h("output", {}));
    this.differences = pins.map(() => h("span", { class: "quiet" }));
    const entry = (pin, k) => {
      const name = pin.title || `pinned ${k + 1}`;
      const again = h("button", { type: "button", class: "plain", title: "Open this design again", onclick: () => this.session.open(pin.toml, pin.source) }, name);
      const off = h("button", { type: "button", class: "plain", "aria-label": `Unpin ${name}`, onclick: () => this.session.rest.unpin(pin) }, "×");
      return h("li", { class: "ghost" }, line(GHOSTS[k]), again, this.differences[k], this.values[k], off);
    };
    this.legend.replaceChildren(h("li", {}, line("--curve-0"), this.azimuth), ...pins.map(entry));
    this.listed = pins;
  }

  tellPins() {
    const { base, rest, direction } = this.session;
    if (this.listed !== rest.pins) this.listPins();
    this.azimuth.textContent = `this design, azimuth ${short(direction.azimuth_deg)}°`;
    rest.pins.forEach((pin, k) => {
      this.values[k].textContent = percent(valueAt(pin.pass, direction.incidence_deg), 1);
      this.differences[k].textContent = base ? differenceText(pin.toml, base.toml) : "";
    });
  }

  save(kind) {
    const { curve, rest, base, direction } = this.session;
    if (!curve.shown) return;
    const curves = [{ title: base.title || "this design", rows: curve.shown.rows(), name: "--curve-0" }].concat(
      rest.pins.filter((pin) => pin.pass).map((pin, k) => ({ title: pin.title || `pinned ${k + 1}`, rows: pin.pass.rows(), name: GHOSTS[k] })),
    );
    if (kind === "csv") save("rre_curve.csv", "text/csv", curveCsv(curves, direction.azimuth_deg));
    else save("rre_curve.svg", "image/svg+xml", curveSvg(curves, direction.azimuth_deg, this.reachOf()));
  }
}
