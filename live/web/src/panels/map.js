// Map of RRE over all directions, as seen from the source. The centre is normal incidence; +x is to the right.
import { Canvas, h } from "../dom.js";
import { panel } from "../frame.js";
import { percent, short } from "../units.js";
import { colourOnScale, rgbOf } from "../../../../report/page/web/src/colour_scale.js";
import { colour } from "../../../../report/page/web/src/theme.js";

// ColorBrewer YlGnBu from dark to light, as for maps in reports: lighter means more, in the light and the dark theme.
const SCALE = ["#081d58", "#253494", "#225ea8", "#1d91c0", "#41b6c4", "#7fcdbb", "#c7e9b4", "#edf8b1", "#ffffd9"].map(rgbOf);
const SIZE = 240; // size in pixels of the picture that is scaled to the disc

/** 256 colours from minimum to maximum. */
const COLOURS = Array.from({ length: 256 }, (_, k) => colourOnScale(SCALE, k / 255));

/** Returns, for each pixel, the distance from the centre relative to the radius, and the azimuth in turns. */
function polarPixels() {
  const away = new Float32Array(SIZE * SIZE);
  const turn = new Float32Array(SIZE * SIZE);
  for (let k = 0; k < SIZE * SIZE; ++k) {
    const x = (2 * ((k % SIZE) + 0.5)) / SIZE - 1;
    const y = 1 - (2 * (Math.floor(k / SIZE) + 0.5)) / SIZE;
    away[k] = Math.hypot(x, y);
    turn[k] = (Math.atan2(y, x) / (2 * Math.PI) + 1) % 1;
  }
  return { away, turn };
}

/** Returns the value on a ring by linear interpolation. */
function onRing(values, turn) {
  const at = turn * values.length;
  const k = Math.floor(at) % values.length;
  return values[k] + (at - Math.floor(at)) * (values[(k + 1) % values.length] - values[k]);
}

export class MapPanel {
  constructor(session) {
    this.session = session;
    this.element = h("div", {
      class: "picture map-view",
      tabindex: "0",
      role: "application",
      "aria-label":
        "RRE over all directions of the light. Left and right arrows change the selected azimuth, up and down arrows the selected incidence.",
    });
    this.caption = h("p", { class: "caption" });
    this.bar = h("div", { class: "map-bar", "aria-hidden": "true" }, h("span", {}, "0"), h("i"), h("span", {}, "100 %"));
    this.spoken = h("p", { class: "spoken", "aria-live": "polite" });
    this.selected = h("span", {});
    const legend = h(
      "p",
      { class: "legend" },
      h("span", { class: "entry" }, h("span", { class: "ring" }), this.selected),
      h("span", { class: "entry" }, h("span", { class: "stroke across" }), "directions of the curve"),
    );
    this.node = panel("map", "RRE over all directions", {}, this.element, this.bar, legend, this.caption, this.spoken);
    this.picture = document.createElement("canvas");
    this.picture.width = this.picture.height = SIZE;
    this.pixels = polarPixels();
  }

  start() {
    this.canvas = new Canvas(this.element, () => this.draw());
    this.session.on("map", (pass) => this.show(pass));
    this.session.on("map_progress", (pass) => this.tell(pass));
    this.session.on("direction", () => this.draw());
    for (const event of ["answer", "rested"]) this.session.on(event, () => this.tellSelected());
    this.paintBar();
    this.draw();
    const at = (event) => {
      const { x, y, radius } = this.disc();
      const [px, py] = this.canvas.placeOf(event);
      const away = Math.min(1, Math.hypot(px - x, py - y) / radius);
      const incidence = Math.round(2 * away * this.session.map.most_deg) / 2;
      this.session.look(incidence, incidence ? Math.round((Math.atan2(y - py, px - x) * 180) / Math.PI) : 0);
    };
    this.canvas.node.addEventListener("pointerdown", (event) => {
      this.canvas.node.setPointerCapture(event.pointerId);
      this.isHeld = true;
      at(event);
    });
    this.canvas.node.addEventListener("pointermove", (event) => this.isHeld && at(event));
    for (const end of ["pointerup", "pointercancel"]) this.canvas.node.addEventListener(end, () => (this.isHeld = false));
    this.element.addEventListener("keydown", (event) => this.press(event));
  }

  press(event) {
    const moves = { ArrowLeft: [0, 5], ArrowRight: [0, -5], ArrowUp: [1, 0], ArrowDown: [-1, 0] };
    if (!moves[event.key]) return;
    event.preventDefault();
    const { incidence_deg, azimuth_deg } = this.session.direction;
    const [more, turn] = moves[event.key];
    this.session.look(Math.max(0, incidence_deg + more), azimuth_deg + turn);
    const { direction } = this.session;
    this.spoken.textContent = `Incidence ${direction.incidence_deg}, azimuth ${direction.azimuth_deg} degrees`;
  }

  paintBar() {
    const stops = COLOURS.filter((_, k) => k % 15 === 0);
    this.bar.querySelector("i").style.background = `linear-gradient(to right, ${stops.map((c) => `rgb(${c})`).join(",")})`;
  }

  /** Redraws after a change of the colour theme. */
  recolour() {
    this.draw();
  }

  /** Shows the selected direction and its RRE in the legend. */
  tellSelected() {
    const { answer, direction } = this.session;
    const at = `incidence ${short(direction.incidence_deg)}°, azimuth ${short(direction.azimuth_deg)}°`;
    this.selected.textContent = answer ? `${at}: ${percent(answer.rre, 1)}` : at;
  }

  disc() {
    const { width, height } = this.canvas;
    const radius = Math.max(20, Math.min(width / 2 - 26, height / 2 - 18));
    return { x: width / 2, y: height / 2, radius };
  }

  show(pass) {
    this.pass = pass;
    this.paint();
    this.draw();
    this.tell(pass);
    this.session.measure.shown("map", pass.stamp);
    this.element.dataset.level = pass.level;
  }

  tell(pass) {
    const done = pass.values.size;
    const finer = pass.queue.length ? `, ${pass.queue.length} remaining` : "";
    this.caption.textContent = `Select a direction. The edge of the map is ${pass.most_deg}° from the normal; ${done} directions are accurate to 10⁻³${finer}.`;
  }

  /** Draws the disc, interpolated linearly between rings. Pixels outside are transparent. */
  paint() {
    const context = this.picture.getContext("2d");
    const image = context.createImageData(SIZE, SIZE);
    const pixels = new Uint32Array(image.data.buffer);
    const colours = Uint32Array.from(COLOURS, ([r, g, b]) => (255 << 24) | (b << 16) | (g << 8) | r);
    const { away, turn } = this.pixels;
    const { rings } = this.pass;
    const values = rings.map((ring) => ring.values);
    for (let k = 0; k < pixels.length; ++k) {
      if (away[k] > 1.01) continue;
      const at = Math.min(1, away[k]) * (rings.length - 1);
      const low = Math.min(rings.length - 2, Math.floor(at));
      const value = onRing(values[low], turn[k]) * (1 - at + low) + onRing(values[low + 1], turn[k]) * (at - low);
      pixels[k] = colours[Math.max(0, Math.min(255, Math.round(255 * value)))];
    }
    context.putImageData(image, 0, 0);
  }

  draw() {
    if (this.canvas.width < 2) return;
    const context = this.canvas.begin();
    const { x, y, radius } = this.disc();
    if (this.pass) {
      context.save();
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.clip();
      context.imageSmoothingQuality = "high";
      context.drawImage(this.picture, x - radius, y - radius, 2 * radius, 2 * radius);
      context.restore();
    }
    this.drawGrid(context, x, y, radius);
    this.drawCurve(context, x, y, radius);
    this.drawPointer(context, x, y, radius);
  }

  drawGrid(context, x, y, radius) {
    const most = this.session.map.most_deg;
    context.font = "11px DejaVu Sans, system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "middle";
    const step = most > 40 ? 20 : 10;
    for (let deg = step; deg <= most; deg += step) {
      context.beginPath();
      context.arc(x, y, (radius * deg) / most, 0, 2 * Math.PI);
      context.strokeStyle = deg === most ? colour("--line") : "rgba(128,138,150,0.45)";
      context.lineWidth = 1;
      context.stroke();
    }
    context.fillStyle = colour("--quiet");
    for (let turn = 0; turn < 360; turn += 90) {
      const angle = (turn * Math.PI) / 180;
      context.fillText(`${turn}°`, x + (radius + 15) * Math.cos(angle), y - (radius + 10) * Math.sin(angle));
    }
  }

  /** Draws the directions of the curve next to the map: a diameter at the selected azimuth. */
  drawCurve(context, x, y, radius) {
    const turn = (this.session.direction.azimuth_deg * Math.PI) / 180;
    const [dx, dy] = [radius * Math.cos(turn), -radius * Math.sin(turn)];
    context.save();
    for (const [width, dash, paint] of [
      [2.5, [], "rgba(255,255,255,0.55)"],
      [1.25, [5, 4], colour("--scale-curve")],
    ]) {
      context.setLineDash(dash);
      context.strokeStyle = paint;
      context.lineWidth = width;
      context.beginPath();
      context.moveTo(x - dx, y - dy);
      context.lineTo(x + dx, y + dy);
      context.stroke();
    }
    context.restore();
  }

  drawPointer(context, x, y, radius) {
    const { incidence_deg, azimuth_deg } = this.session.direction;
    const away = Math.min(1, Math.abs(incidence_deg) / this.session.map.most_deg) * radius;
    const turn = ((azimuth_deg + (incidence_deg < 0 ? 180 : 0)) * Math.PI) / 180;
    const at = [x + away * Math.cos(turn), y - away * Math.sin(turn)];
    for (const [width, name] of [
      [4, "--scale-low"],
      [2, "--scale-mark"],
    ]) {
      context.strokeStyle = colour(name);
      context.lineWidth = width;
      context.beginPath();
      context.arc(...at, 6, 0, 2 * Math.PI);
      context.stroke();
    }
  }
}
