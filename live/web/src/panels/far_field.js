// Directions of the returned light as seen from the source: spots around the acceptance cone.
import { h, s } from "../dom.js";
import { panel } from "../frame.js";
import { angle, percent, short } from "../units.js";

const MAX_SPOTS = 6; // maximum number of spots in the list
const HALF = 110; // half width of the drawing in its units
const REACHES_DEG = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 90, 180];
const MIN_POWER = 1e-5; // minimum power of a spot that influences the range of the drawing

export class FarFieldPanel {
  constructor(session) {
    this.session = session;
    this.drawing = s("svg", { viewBox: `${-HALF - 8} ${-HALF - 8} ${2 * HALF + 16} ${2 * HALF + 16}`, role: "img", "aria-label": "Spots of the far field" });
    this.reach = h(
      "select",
      { "aria-label": "Displayed range of directions", onchange: () => this.show() },
      h("option", { value: "near" }, "near the return direction"),
      h("option", { value: "far" }, "all directions"),
      h("option", { value: "annulus" }, "annulus of velocity aberration"),
    );
    // Angles of the annulus in seconds of arc. The default is that of satellites at heights of 400 km to 20000 km.
    this.annulus = [
      ["Inner", 5],
      ["Outer", 11],
    ].map(([name, value]) => h("input", { type: "number", min: 0, step: "any", value, "aria-label": `${name} angle of the annulus in seconds of arc`, onchange: () => this.show() }));
    this.annulusRow = h("p", { class: "caption annulus" }, "Annulus from ", this.annulus[0], " to ", this.annulus[1], " ″");
    this.rows = h("tbody", {});
    this.rest = h("p", { class: "caption" });
    const table = h(
      "table",
      {},
      h("thead", {}, h("tr", {}, ...["", "Deviation", "Towards", "Power", "Hits"].map((text, k) => h("th", { scope: "col", class: k > 0 ? "n" : "" }, text)))),
      this.rows,
    );
    this.node = panel("far", "Far field", { tools: [this.reach] }, h("div", { class: "far-box" }, this.drawing, h("div", { class: "table-box" }, table)), this.annulusRow, this.rest);
  }

  start() {
    this.session.on("answer", () => this.take(this.session.answer));
    this.session.on("rested", (answer) => this.take(answer));
  }

  take(answer) {
    this.field = answer && answer.far_field;
    this.cone_deg = answer ? answer.acceptance_half_angle_deg : 0.5;
    this.show();
  }

  /** Returns the inner and outer angle of the displayed annulus in degrees, or null if no annulus is displayed. */
  ring() {
    if (this.reach.value !== "annulus") return null;
    const angles = this.annulus.map(({ value }) => Number(value) / 3600);
    return Math.max(...angles) > 0 ? [Math.min(...angles), Math.max(...angles)] : null;
  }

  /** Returns the half width of the drawing in degrees. It contains the cone and the near spots, or the annulus, or all
   * spots. */
  width() {
    const ring = this.ring();
    if (ring) return REACHES_DEG.find((deg) => deg >= 1.15 * ring[1]) || 180;
    const away = this.field.spots.filter(({ power }) => power > MIN_POWER).map(({ deviation_deg }) => deviation_deg);
    const near = this.reach.value === "near" ? away.filter((deg) => deg <= Math.max(5, 3 * this.cone_deg)) : away;
    const most = 1.15 * Math.max(this.cone_deg, ...near);
    return REACHES_DEG.find((deg) => deg >= most) || 180;
  }

  show() {
    if (!this.field) {
      this.drawing.replaceChildren();
      this.rows.replaceChildren();
      this.rest.textContent = "";
      return;
    }
    const ring = this.ring();
    this.annulusRow.hidden = this.reach.value !== "annulus";
    const reach = this.width();
    const scale = HALF / reach;
    const rings = [0.5, 1].map((share) => s("circle", { class: "guide", r: share * HALF }));
    const cones = ring
      ? ring.map((deg) => s("circle", { class: "annulus", r: deg * scale }))
      : [s("circle", { class: "cone", r: Math.max(1.5, this.cone_deg * scale) })];
    const label = s("text", { x: HALF * 0.71 + 3, y: HALF * 0.71 + 8 }, angle(reach));
    this.labels = [];
    const spots = this.field.spots
      .map((spot, k) => ({ ...spot, k }))
      .filter(({ deviation_deg }) => deviation_deg <= reach)
      .map((spot) => this.spotOf(spot, scale));
    this.drawing.replaceChildren(...rings, ...cones, label, ...spots.reverse());
    this.list();
  }

  spotOf({ deviation_deg, orientation_deg, power, depth, k }, scale) {
    const turn = (orientation_deg * Math.PI) / 180;
    const x = deviation_deg * scale * Math.cos(turn);
    const y = -deviation_deg * scale * Math.sin(turn);
    const radius = Math.max(1.4, 13 * Math.sqrt(power));
    const group = s("g", { class: depth === 0 ? "spot front" : "spot" }, s("circle", { cx: x, cy: y, r: radius }, s("title", {}, `${percent(power)} at ${angle(deviation_deg)}`)));
    const isFree = !this.labels.some(([lx, ly]) => Math.hypot(lx - x, ly - y) < 8);
    if (k < MAX_SPOTS && isFree) {
      this.labels.push([x, y]);
      group.append(s("text", { x: x + radius + 2, y: y + 3 }, String(k + 1)));
    }
    return group;
  }

  /** Returns the power of all spots in an annulus. */
  powerWithin([inner, outer]) {
    return this.field.spots.filter(({ deviation_deg }) => deviation_deg >= inner && deviation_deg <= outer).reduce((sum, { power }) => sum + power, 0);
  }

  list() {
    const { spots, other_power, total_power } = this.field;
    this.rows.replaceChildren(
      ...spots.slice(0, MAX_SPOTS).map((spot, k) =>
        h(
          "tr",
          {},
          h("th", { scope: "row" }, k + 1),
          h("td", { class: "n" }, angle(spot.deviation_deg)),
          h("td", { class: "n" }, spot.deviation_deg < 1e-6 ? "source" : `${short(spot.orientation_deg, 3)}°`),
          h("td", { class: "n" }, percent(spot.power)),
          h("td", { class: "n" }, spot.depth || "front"),
        ),
      ),
    );
    const more = spots.slice(MAX_SPOTS).reduce((sum, { power }) => sum + power, other_power || 0);
    const ring = this.ring();
    const legend = ring
      ? `The annulus contains ${percent(this.powerWithin(ring))}, without diffraction; \`retrace ranging\` computes the cross section.`
      : `The coloured ring is the acceptance cone, ${angle(this.cone_deg)}.`;
    this.rest.textContent = `${legend} ${percent(total_power)} of the light leaves the entrance face; ${percent(more)} in directions that are not in this list.`;
  }
}
