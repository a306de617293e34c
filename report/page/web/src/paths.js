// Drawing of a tool path in a section, to scale. The user can zoom, move the drawing, and hide kinds of motion.
const SVG = "http://www.w3.org/2000/svg";

function boundsOf(path) {
  const low = [Infinity, Infinity];
  const high = [-Infinity, -Infinity];
  for (const kind of path.kinds)
    for (const move of kind.moves)
      move.forEach((c, k) => {
        low[k % 2] = Math.min(low[k % 2], c);
        high[k % 2] = Math.max(high[k % 2], c);
      });
  const margin = 0.04 * Math.max(high[0] - low[0], high[1] - low[1], 1e-6);
  return { x: low[0] - margin, y: low[1] - margin, width: high[0] - low[0] + 2 * margin, height: high[1] - low[1] + 2 * margin };
}

function shown(value) {
  return String(Number(value.toPrecision(5)));
}

/** Creates the lines of one kind of motion in mm, with y upwards. Their colours follow the theme. */
function linesOf(kind, index) {
  const node = document.createElementNS(SVG, "path");
  node.setAttribute("d", kind.moves.map((m) => `M${m[0]} ${-m[1]}L${m[2]} ${-m[3]}`).join(""));
  node.setAttribute("vector-effect", "non-scaling-stroke");
  node.style.stroke = `var(--curve-${index % 7})`;
  if (kind.dashed) node.style.strokeDasharray = "4 3";
  return node;
}

function choiceOf(kind, index, line) {
  const label = document.createElement("label");
  const input = document.createElement("input");
  input.type = "checkbox";
  input.checked = true;
  input.addEventListener("change", () => (line.style.display = input.checked ? "" : "none"));
  const swatch = document.createElement("span");
  swatch.className = "swatch";
  swatch.style.background = `var(--curve-${index % 7})`;
  label.append(input, swatch, kind.label);
  return label;
}

function draw(figure, path) {
  const area = figure.querySelector(".path");
  area.tabIndex = 0;
  area.setAttribute("role", "application");
  area.setAttribute("aria-label", `${path.title}. Plus and minus zoom, arrows move, 0 shows all.`);
  const svg = document.createElementNS(SVG, "svg");
  const lines = path.kinds.map(linesOf);
  svg.append(...lines);
  const kinds = document.createElement("div");
  kinds.className = "path-kinds";
  kinds.append(...path.kinds.map((kind, index) => choiceOf(kind, index, lines[index])));
  const place = document.createElement("p");
  place.className = "path-place";
  place.setAttribute("aria-live", "polite");
  area.append(svg);
  figure.prepend(kinds);
  figure.insertBefore(place, figure.querySelector("figcaption"));

  const whole = boundsOf(path);
  let view = { ...whole };
  const show = () => {
    svg.setAttribute("viewBox", [view.x, -view.y - view.height, view.width, view.height].join(" "));
    figure.dataset.view = [view.x, view.y, view.width, view.height].join(" ");
    place.textContent =
      `${path.x_label}: ${shown(view.x)} to ${shown(view.x + view.width)}; ` +
      `${path.y_label}: ${shown(view.y)} to ${shown(view.y + view.height)}`;
  };
  const zoom = (factor, u = 0.5, v = 0.5) => {
    const width = Math.min(whole.width, Math.max(1e-5, view.width * factor));
    const height = (width * whole.height) / whole.width;
    view = { x: view.x + u * (view.width - width), y: view.y + v * (view.height - height), width, height };
    show();
  };
  const move = (across, up) => {
    view.x += across * view.width;
    view.y += up * view.height;
    show();
  };
  const all = () => {
    view = { ...whole };
    show();
  };
  area.addEventListener("keydown", (event) => {
    const actions = {
      "+": () => zoom(0.7),
      "-": () => zoom(1 / 0.7),
      0: all,
      ArrowLeft: () => move(-0.15, 0),
      ArrowRight: () => move(0.15, 0),
      ArrowUp: () => move(0, 0.15),
      ArrowDown: () => move(0, -0.15),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  });
  area.addEventListener("dblclick", all);
  area.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey) return; // without the Ctrl key, the wheel scrolls the page
      event.preventDefault();
      const box = svg.getBoundingClientRect();
      zoom(event.deltaY < 0 ? 0.85 : 1 / 0.85, (event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height);
    },
    { passive: false },
  );
  area.addEventListener("pointerdown", () => area.classList.add("held"));
  window.addEventListener("pointerup", () => area.classList.remove("held"));
  area.addEventListener("pointermove", (event) => {
    if (!area.classList.contains("held")) return;
    const box = svg.getBoundingClientRect();
    move(-event.movementX / box.width, event.movementY / box.height);
  });
  show();
}

export function drawPaths(paths) {
  for (const figure of document.querySelectorAll("figure[data-path]")) draw(figure, paths[Number(figure.dataset.path)]);
}
