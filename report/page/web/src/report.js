// Adds interactive elements to a report: charts, the three-dimensional view, downloads and the choice of a light or
// dark theme. Tables, figures and findings are part of the document and are also shown without these scripts.
import { drawCharts } from "./charts.js";
import { followSections } from "./contents.js";
import { drawPaths } from "./paths.js";
import { startScene } from "./scene.js";
import { addDownloads, fitTables } from "./tables.js";
import { addThemeSwitch } from "./theme.js";

/** \param more function that redraws other content of the page after a change of the theme */
export function startReport(more = () => {}) {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const redraw = [more];
  addThemeSwitch(() => redraw.forEach((draw) => draw()));
  addDownloads();
  fitTables();
  followSections();
  redraw.push(drawCharts(data.charts || []));
  drawPaths(data.paths || []);
  const view = document.getElementById("scene");
  if (view && data.scene) redraw.push(startScene(view, data.scene));
  document.documentElement.dataset.ready = "yes";
}
