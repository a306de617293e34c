// Replaces the three-dimensional view if WebGL is not available: the solid and the paths from one direction, as SVG.
import { colour } from "./theme.js";

const SVG = "http://www.w3.org/2000/svg";

/**
 * Projects a point. The viewing direction is from the front right, slightly from above.
 * \return x, y (downwards) and depth
 */
function seen([x, y, z]) {
  const azimuth = -0.52;
  const height = 0.32;
  const along = x * Math.cos(azimuth) - y * Math.sin(azimuth);
  const away = x * Math.sin(azimuth) + y * Math.cos(azimuth);
  return [along, -(z * Math.cos(height) + away * Math.sin(height)), away * Math.cos(height) - z * Math.sin(height)];
}

function add(parent, name, attributes) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  parent.append(node);
  return node;
}

export function drawStill(view, scene, shown) {
  const points = scene.vertices.map(seen);
  const paths = scene.paths.filter((_, k) => shown < 0 || k === shown);
  const all = [...points, ...paths.flatMap((p) => p.points.map(seen))];
  const xs = all.map((p) => p[0]);
  const ys = all.map((p) => p[1]);
  const left = Math.min(...xs);
  const top = Math.min(...ys);
  const size = Math.max(Math.max(...xs) - left, Math.max(...ys) - top);
  const svg = document.createElementNS(SVG, "svg");
  const margin = 0.05 * size;
  svg.setAttribute("viewBox", [left - margin, top - margin, Math.max(...xs) - left + 2 * margin, Math.max(...ys) - top + 2 * margin].join(" "));
  const corners = (list) => list.map((p) => `${p[0].toFixed(5)},${p[1].toFixed(5)}`).join(" ");
  const far = (t) => t.reduce((sum, v) => sum + points[v][2], 0);
  for (const t of [...scene.triangles].sort((a, b) => far(b) - far(a)))
    add(svg, "polygon", { points: corners(t.map((v) => points[v])), fill: scene.glass || colour("--glass"), "fill-opacity": 0.12 });
  for (const patch of scene.patches || [])
    add(svg, "polygon", { points: corners(patch.points.map(seen)), fill: colour(patch.colour || "--active"), "fill-opacity": patch.opacity });
  for (const [a, b] of scene.edges)
    add(svg, "polyline", { points: corners([points[a], points[b]]), fill: "none", stroke: colour("--edge"), "stroke-width": 0.002 * size });
  paths.forEach((path) => {
    const index = scene.paths.indexOf(path);
    add(svg, "polyline", { points: corners(path.points.map(seen)), fill: "none", stroke: colour(path.colour || `--curve-${index % 7}`), "stroke-width": 0.006 * size });
  });
  view.replaceChildren(svg);
}
