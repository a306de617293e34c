// What a report's page adds to its document: charts, the view in three dimensions, downloads and the choice between light
// and dark. The page works without: tables, figures and findings are in the document.
import { drawCharts } from "./charts.js";
import { drawPaths } from "./paths.js";
import { startScene } from "./scene.js";
import { addDownloads } from "./tables.js";
import { addThemeSwitch } from "./theme.js";

/** \param more redraws what else is on the page, in other colours */
export function startReport(more = () => {}) {
  const data = JSON.parse(document.getElementById("page-data").textContent);
  const redraw = [more];
  addThemeSwitch(() => redraw.forEach((draw) => draw()));
  addDownloads();
  redraw.push(drawCharts(data.charts || []));
  drawPaths(data.paths || []);
  const view = document.getElementById("scene");
  if (view && data.scene) redraw.push(startScene(view, data.scene));
  document.documentElement.dataset.ready = "yes";
}
