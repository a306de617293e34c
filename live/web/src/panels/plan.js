// Entrance face as seen from the light: the regions whose light returns, and the dead zones between them.
import { Canvas, h } from "../dom.js";
import { button, panel } from "../frame.js";
import { percent, short } from "../units.js";
import { colourOnScale, rgbOf } from "../../../../report/page/web/src/colour_scale.js";
import { colour } from "../../../../report/page/web/src/theme.js";

function corners(flat) {
  return Array.from({ length: flat.length / 2 }, (_, k) => [flat[2 * k], flat[2 * k + 1]]);
}

function contains(polygon, [x, y]) {
  return polygon.every(([ax, ay], k) => {
    const [bx, by] = polygon[(k + 1) % polygon.length];
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= -1e-12;
  });
}

/**
 * Returns the translations by which an outline tiles the plane: from the centre of each side to that of the opposite
 * side.
 */
function translationsOf(outline) {
  const count = outline.length;
  if (count % 2) return [];
  const middle = (k) => [0, 1].map((c) => (outline[k % count][c] + outline[(k + 1) % count][c]) / 2);
  return Array.from({ length: count / 2 }, (_, k) => middle(k + count / 2).map((c, i) => c - middle(k)[i]));
}

function boxOf(points) {
  const xs = points.map((p) => p[0]);
  const ys = points.map((p) => p[1]);
  return { x: Math.min(...xs), y: Math.min(...ys), width: Math.max(...xs) - Math.min(...xs), height: Math.max(...ys) - Math.min(...ys) };
}

const MAX_TILES = 3; // number of periods on each side of the central period

/** Plan of a part. It does not change while the direction of light changes. */
class Plan {
  constructor(part) {
    this.outline = corners(part.outline);
    this.isPeriodic = part.periodic;
    this.shift = part.shift_mm || [0, 0];
    this.rims = part.rims || [];
    this.roots = part.roots || [];
    this.box = boxOf(this.outline);
    this.periods = this.isPeriodic ? translationsOf(this.outline).slice(0, 2) : [];
  }

  /**
   * Returns the visible area: the part with a margin, or the central period of an infinite array with its neighbours.
   */
  seen() {
    const { x, y, width, height } = this.box;
    const size = Math.max(width, height);
    const around = this.isPeriodic ? 0.8 * size : 0.06 * size;
    return { x: x - around, y: y - around, width: width + 2 * around, height: height + 2 * around };
  }

  tiles() {
    if (this.periods.length < 2) return [[0, 0]];
    const [a, b] = this.periods;
    const steps = Array.from({ length: 2 * MAX_TILES + 1 }, (_, k) => k - MAX_TILES);
    return steps.flatMap((i) => steps.map((j) => [i * a[0] + j * b[0], i * a[1] + j * b[1]]));
  }

  /** Returns the tiles that overlap the rectangle between two corners. */
  tilesWithin([left, bottom], [right, top]) {
    const { x, y, width, height } = this.box;
    return this.tiles().filter(
      ([dx, dy]) => x + dx < right && x + dx + width > left && y + dy < top && y + dy + height > bottom,
    );
  }

  /** Returns the equivalent position in the central period. */
  home([x, y]) {
    if (contains(this.outline, [x, y])) return [x, y];
    for (const [dx, dy] of this.tiles()) if (contains(this.outline, [x - dx, y - dy])) return [x - dx, y - dy];
    return null;
  }
}

export class PlanPanel {
  constructor(session) {
    this.session = session;
    this.element = h("div", {
      class: "picture plan-view",
      tabindex: "0",
      role: "application",
      "aria-label": "Plan of the entrance face. Arrow keys move the spot whose ray is shown; Escape shows the most frequent paths again.",
    });
    this.all = button("All paths", () => this.leave(), { hidden: true });
    this.caption = h("p", { class: "caption", "aria-live": "polite" });
    const entry = (mark, text) => h("span", { class: "entry" }, h("span", { class: mark }), text);
    this.period = entry("stroke", "one period");
    const legend = h("p", { class: "legend" }, entry("swatch scale", "returned light: none to all"), entry("swatch hatched", "dead zone"), this.period);
    this.node = panel("plan", "Plan and footprint", { tools: [this.all] }, this.element, legend, this.caption);
  }

  start() {
    this.canvas = new Canvas(this.element, () => this.draw());
    this.session.on("answer", ({ isNewPart }) => this.show(isNewPart));
    this.session.on("rested", () => this.show(false));
    const pickAt = (event) => {
      const place = this.plan && this.plan.home(this.toPlan(this.canvas.placeOf(event)));
      if (place) this.session.pick(place);
    };
    this.canvas.node.addEventListener("pointerdown", (event) => {
      this.canvas.node.setPointerCapture(event.pointerId);
      this.isHeld = true;
      pickAt(event);
    });
    this.canvas.node.addEventListener("pointermove", (event) => this.isHeld && pickAt(event));
    for (const end of ["pointerup", "pointercancel"]) this.canvas.node.addEventListener(end, () => (this.isHeld = false));
    this.element.addEventListener("keydown", (event) => this.press(event));
  }

  press(event) {
    const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (event.key === "Escape") this.leave();
    else if (moves[event.key] && this.plan) {
      event.preventDefault();
      const { x, y, width, height } = this.plan.box;
      const step = 0.02 * Math.min(width, height);
      const from = this.session.spot || [x + width / 2, y + height / 2];
      const place = this.plan.home(from.map((c, k) => c + step * moves[event.key][k]));
      if (place) this.session.pick(place);
    }
  }

  recolour() {
    this.draw();
  }

  leave() {
    if (this.session.spot) this.session.pick(null);
  }

  show(isNewPart) {
    if (!this.session.part) return;
    if (isNewPart || !this.plan) {
      this.plan = new Plan(this.session.part);
      this.period.hidden = !this.plan.isPeriodic;
      const { spot } = this.session;
      if (spot && !this.plan.home(spot)) this.session.pick(null);
    }
    const { answer } = this.session;
    this.regions = answer && answer.footprint ? answer.footprint.regions.map(({ outline, efficiency }) => ({ outline: corners(outline), efficiency })) : [];
    this.paintRegions();
    this.all.hidden = !this.session.spot;
    this.draw();
    this.tell();
  }

  /** Draws the regions in opaque colours between the colours for no light and for all light. */
  paintRegions() {
    const scale = ["--scale-low", "--scale-high"].map((name) => rgbOf(colour(name)));
    for (const region of this.regions || []) {
      region.paint = `rgb(${colourOnScale(scale, 0.1 + 0.9 * region.efficiency)})`;
    }
  }

  /** Writes a sentence about the result below the picture. */
  tell() {
    const { answer, spot } = this.session;
    if (!answer || !answer.footprint) {
      this.caption.textContent = "";
      return;
    }
    if (!spot) {
      const { active_fraction } = answer.footprint;
      this.caption.textContent = `Light returns from ${percent(active_fraction, 1)} of the face. Select a spot to follow its ray.`;
      return;
    }
    const hit = this.regions.find(({ outline }) => contains(outline, spot));
    const where = `(${short(spot[0])}, ${short(spot[1])}) mm`;
    this.caption.textContent = hit ? `At ${where} ${percent(hit.efficiency, 1)} of the light returns.` : `${where} is in a dead zone.`;
  }

  // --- drawing

  toPlan([px, py]) {
    const { scale, left, top } = this.transform;
    return [(px - left) / scale, (top - py) / scale];
  }

  draw() {
    if (!this.plan || this.canvas.width < 2) return;
    const context = this.canvas.begin();
    const { width, height } = this.canvas;
    const seen = this.plan.seen();
    const scale = Math.min(width / seen.width, height / seen.height);
    const left = width / 2 - scale * (seen.x + seen.width / 2);
    const top = height / 2 + scale * (seen.y + seen.height / 2);
    this.transform = { scale, left, top };
    this.hatching = this.hatching || this.makeHatching();
    context.save();
    context.setTransform(this.canvas.ratio * scale, 0, 0, -this.canvas.ratio * scale, this.canvas.ratio * left, this.canvas.ratio * top);
    for (const tile of this.plan.tilesWithin(this.toPlan([0, height]), this.toPlan([width, 0]))) this.drawTile(context, tile, 1 / scale);
    if (this.plan.isPeriodic) this.drawPeriod(context, 1 / scale);
    this.drawRay(context, 1 / scale);
    context.restore();
    this.drawScale(context, scale);
  }

  /** Draws one period of an infinite array, or a complete finite part. */
  drawTile(context, [dx, dy], unit) {
    context.save();
    context.translate(dx, dy);
    this.trace(context, this.plan.outline);
    context.fillStyle = colour("--scale-low");
    context.fill();
    this.hatch(context, unit);
    for (const { outline, paint } of this.regions) {
      this.trace(context, outline);
      context.fillStyle = context.strokeStyle = paint;
      context.lineWidth = 0.6 * unit; // covers the seams between regions
      context.fill();
      context.stroke();
    }
    this.lines(context, this.plan.roots, unit, "--scale-line", 0.5);
    this.lines(context, this.plan.rims, 1.3 * unit, "--scale-line", 1);
    context.restore();
  }

  /** Draws the outline of the period, to which all numbers refer. */
  drawPeriod(context, unit) {
    context.save();
    this.trace(context, this.plan.outline);
    context.setLineDash([5 * unit, 4 * unit]);
    context.strokeStyle = colour("--scale-period");
    context.lineWidth = 1.4 * unit;
    context.stroke();
    context.restore();
  }

  trace(context, polygon) {
    context.beginPath();
    polygon.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
    context.closePath();
  }

  /** Hatches the dead zones. Regions are drawn over the hatching later. */
  hatch(context, unit) {
    context.fillStyle = this.hatching;
    this.hatching.setTransform(new DOMMatrix([unit / this.canvas.ratio, 0, 0, unit / this.canvas.ratio, 0, 0]));
    context.fill();
  }

  /** Creates a pattern of oblique lines, in screen pixels. */
  makeHatching() {
    const size = Math.round(8 * this.canvas.ratio);
    const tile = document.createElement("canvas");
    tile.width = tile.height = size;
    const context = tile.getContext("2d");
    context.strokeStyle = colour("--scale-hatch");
    context.lineWidth = this.canvas.ratio;
    for (const shift of [-size, 0, size]) {
      context.moveTo(shift, 0);
      context.lineTo(shift + size, size);
    }
    context.stroke();
    return context.createPattern(tile, "repeat");
  }

  lines(context, flat, width, name, alpha) {
    context.save();
    context.globalAlpha *= alpha;
    context.beginPath();
    for (let k = 0; k < flat.length; k += 4) {
      context.moveTo(flat[k], flat[k + 1]);
      context.lineTo(flat[k + 2], flat[k + 3]);
    }
    context.strokeStyle = colour(name);
    context.lineWidth = width;
    context.stroke();
    context.restore();
  }

  /** Draws the point at which the selected ray enters, its path in plan, and the point at which it leaves. */
  drawRay(context, unit) {
    const { spot, paths } = this.session;
    if (!spot) return;
    const path = paths[0];
    const paint = colour(path && path.returned ? "--curve-0" : "--curve-1");
    context.strokeStyle = context.fillStyle = paint;
    if (path) {
      const [dx, dy] = this.plan.shift;
      const points = Array.from({ length: path.points.length / 3 }, (_, k) => [path.points[3 * k] - dx, path.points[3 * k + 1] - dy]).slice(1, -1);
      context.beginPath();
      points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
      context.lineWidth = 1.6 * unit;
      context.stroke();
      points.slice(1).forEach((p) => this.dot(context, p, 2.6 * unit));
    }
    this.dot(context, spot, 5 * unit);
    context.strokeStyle = colour("--paper");
    context.lineWidth = 1.5 * unit;
    context.stroke();
  }

  dot(context, [x, y], radius) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
  }

  drawScale(context, scale) {
    const wanted = (0.22 * this.canvas.width) / scale;
    const decade = 10 ** Math.floor(Math.log10(wanted));
    const length = decade * [5, 2, 1].find((f) => f * decade <= wanted);
    const y = this.canvas.height - 12;
    const text = `${short(length)} mm`;
    context.font = "11px DejaVu Sans, system-ui, sans-serif";
    context.fillStyle = colour("--paper");
    context.fillRect(6, y - 18, 12 + Math.max(length * scale, context.measureText(text).width), 24);
    context.strokeStyle = context.fillStyle = colour("--text");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(12, y);
    context.lineTo(12 + length * scale, y);
    context.stroke();
    context.fillText(text, 12, y - 5);
  }
}
