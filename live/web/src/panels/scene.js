// Three-dimensional view of the part with illuminated regions and light paths.
import { h } from "../dom.js";
import { tintOf } from "../body_colour.js";
import { panel } from "../frame.js";
import { openView } from "../../../../report/page/web/src/view.js";

function inThrees(list) {
  return Array.from({ length: list.length / 3 }, (_, k) => list.slice(3 * k, 3 * k + 3));
}

function inTwos(list) {
  return Array.from({ length: list.length / 2 }, (_, k) => list.slice(2 * k, 2 * k + 2));
}

/** Converts a part for the view, with a bounding sphere that includes space for the light above. */
function solidOf(part) {
  const vertices = inThrees(part.vertices);
  const low = [0, 1, 2].map((k) => Math.min(...vertices.map((v) => v[k])));
  const high = [0, 1, 2].map((k) => Math.max(...vertices.map((v) => v[k])));
  const size = Math.hypot(...low.map((l, k) => high[k] - l));
  const middle = low.map((l, k) => (l + high[k]) / 2);
  middle[2] += 0.05 * size;
  // Height of the part in the view from obliquely above. It limits the size of high parts.
  const upright = high[2] - low[2] + 0.33 * Math.hypot(high[0] - low[0], high[1] - low[1]);
  return {
    solid: { vertices, triangles: inThrees(part.triangles), edges: inTwos(part.edges) },
    low,
    high,
    bounds: { middle, size: Math.max(0.9 * size, 1.25 * upright) },
  };
}

export function colourOf(path, index) {
  if (path.returned) return index === 0 ? "--curve-0" : "--curve-5";
  return index === 0 ? "--curve-1" : index === 1 ? "--curve-3" : "--curve-4";
}

export class ScenePanel {
  constructor(session) {
    this.session = session;
    this.element = h("div", {
      class: "picture scene-view",
      tabindex: "0",
      role: "application",
      "aria-label":
        "The part and light paths in three dimensions. Arrow keys rotate the view, plus and minus zoom. The table of rays lists the paths as text.",
    });
    this.remark = h("p", { class: "caption" });
    this.node = panel("scene", "Part and light", {}, this.element, this.remark);
    this.chosen = 0;
    this.listed = "";
  }

  start() {
    this.view = openView(this.element, { follows: true });
    this.session.on("answer", ({ isNewPart }) => this.show(isNewPart));
    this.session.on("rested", () => this.show(false));
    this.session.on("path", (index) => this.choose(index));
    new ResizeObserver(() => this.view.draw()).observe(this.element);
  }

  recolour() {
    this.view.draw();
  }

  patches() {
    const { part, answer } = this.session;
    if (!answer || !answer.footprint) return [];
    const [dx, dy] = part.shift_mm || [0, 0];
    const z = this.solid.high[2] + 1e-4 * this.solid.bounds.size;
    const isOnPiece = ([x, y]) =>
      x > this.solid.low[0] - 1e-9 && x < this.solid.high[0] + 1e-9 && y > this.solid.low[1] - 1e-9 && y < this.solid.high[1] + 1e-9;
    return answer.footprint.regions
      .map(({ outline, efficiency }) => ({ points: inTwos(outline).map(([x, y]) => [x + dx, y + dy, z]), opacity: 0.15 + 0.6 * efficiency }))
      .filter(({ points }) => points.every(isOnPiece));
  }

  show(isNewPart) {
    const { part, paths } = this.session;
    if (!part) return;
    if (isNewPart || !this.solid) {
      this.solid = solidOf(part);
      this.remark.textContent = (part.remarks || []).join("; ");
    }
    const drawn = paths.map((path, index) => ({
      points: inThrees(path.points),
      colour: colourOf(path, index),
      width: index === 0 || path.share == null ? 1 : Math.max(0.45, Math.sqrt(path.share / paths[0].share)),
    }));
    const glass = tintOf(this.session.base);
    this.element.dataset.body = glass || "clear";
    this.view.show({ ...this.solid.solid, glass, paths: drawn, patches: this.patches() }, this.chosen, this.solid.bounds);
  }

  choose(index) {
    this.chosen = index;
    this.view.choose(index);
  }
}
