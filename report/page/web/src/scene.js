// The part and a few light paths in three dimensions, with the list of paths beside it.
import { colourOfPath, openView } from "./view.js";

/** Which path is shown, and what happens to its light. */
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

/** \return what draws it again in other colours */
export function startScene(element, scene) {
  const view = openView(element);
  view.show(scene, scene.paths.length > 0 ? 0 : -1);
  listPaths(scene, (index) => view.choose(index));
  return () => view.draw();
}
