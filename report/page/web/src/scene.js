// Three-dimensional view of the part and of a few light paths, with a list of the paths.
import { colourOfPath, openView } from "./view.js";

/**
 * Lists the paths to choose from, and the events of the chosen path.
 * \param chosen function that is called with the index of the chosen path; -1 means all paths
 */
function listPaths(scene, chosen) {
  const list = document.getElementById("scene-paths");
  const steps = document.getElementById("scene-steps");
  const tell = (index) => {
    steps.replaceChildren(
      ...(index < 0 ? [] : scene.paths[index].events).map((text) => {
        const item = document.createElement("li");
        item.textContent = text;
        return item;
      }),
    );
    chosen(index);
  };
  const add = (index, text) => {
    const label = document.createElement("label");
    const input = document.createElement("input");
    input.type = "radio";
    input.name = "path";
    input.value = String(index);
    input.checked = index === 0;
    input.addEventListener("change", () => tell(index));
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    if (index >= 0) swatch.style.background = `var(${colourOfPath(scene.paths[index], index)})`;
    label.append(input, swatch, text);
    list.append(label);
  };
  scene.paths.forEach((path, index) => add(index, path.label));
  if (scene.paths.length > 1) add(-1, "all of them");
  if (scene.paths.length > 0) tell(0);
}

/** \return function that redraws the view after a change of the theme */
export function startScene(element, scene) {
  const view = openView(element);
  view.show(scene, scene.paths.length > 0 ? 0 : -1);
  listPaths(scene, (index) => view.choose(index));
  return () => view.draw();
}
