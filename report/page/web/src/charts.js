// Interactive charts for pointer and keyboard, drawn with uPlot.
import uPlot from "uplot";
import { colourOnScale } from "./colour_scale.js";
import { colour, isDark } from "./theme.js";

// The following values are those of drawings in files, see report/plot.cpp and report/style.h.
const VIRIDIS = [
  [68, 1, 84],
  [71, 45, 123],
  [59, 82, 139],
  [44, 114, 142],
  [33, 145, 141],
  [40, 174, 128],
  [94, 201, 98],
  [173, 220, 48],
  [253, 231, 37],
];
const DASHES = [[], [7, 3.5], [2, 2.5], [8, 3, 2, 3]];
const MAX_MARKERS = 45;

/** Size of a chart on paper, about the width of a page of A4. */
const PRINTED = { width: 690, height: 300 };
const HEIGHT = 340;
const CURVE_COLOURS = 7; // number of colours --curve-0, --curve-1, ...

/** Returns a colour for a fraction 0..1 of the range of the colour scale. Colours near that of the background are left out. */
function scaleColour(fraction) {
  const position = Math.min(1, Math.max(0, isDark() ? 0.15 + 0.85 * fraction : 0.93 * fraction));
  return `rgb(${colourOnScale(VIRIDIS, position).join(", ")})`;
}

/** Returns the colour of a curve whose style has this number, in charts without a colour scale. */
function curveColour(look) {
  return colour(`--curve-${look % CURVE_COLOURS}`);
}

/** Returns the dashes of a curve whose style has this number. */
function dashesOf(look, hasScale) {
  if (hasScale) return DASHES[look % DASHES.length];
  return look < CURVE_COLOURS ? [] : [6, 4];
}

/** Returns the colour and the dashes of a curve. */
function strokeOf(chart, curve, i) {
  const look = curve.look ?? i;
  const hasScale = chart.scale && curve.value != null;
  if (!hasScale) return { stroke: () => curveColour(look), dash: dashesOf(look, false) };
  const { low, high } = chart.scale;
  const fraction = high > low ? (curve.value - low) / (high - low) : 0.5;
  return { stroke: () => scaleColour(fraction), dash: dashesOf(look, true) };
}

/** Returns the value of a curve at the x value of another curve, by linear interpolation. */
function interpolated(plot, series, i) {
  const [xs, ys] = [plot.data[0], plot.data[series]];
  let low = i;
  let high = i;
  while (low >= 0 && ys[low] == null) --low;
  while (high < ys.length && ys[high] == null) ++high;
  if (low < 0 || high >= ys.length) return null;
  return low === high ? ys[low] : ys[low] + ((ys[high] - ys[low]) * (xs[i] - xs[low])) / (xs[high] - xs[low]);
}

/** Returns all x values of all series, ascending, and the y values of each series with null for missing values. */
export function aligned(series) {
  const xs = [...new Set(series.flatMap((s) => s.x))].sort((a, b) => a - b);
  const place = new Map(xs.map((x, i) => [x, i]));
  const ys = series.map((s) => {
    const y = new Array(xs.length).fill(null);
    s.x.forEach((x, i) => (y[place.get(x)] = s.y[i]));
    return y;
  });
  return [xs, ...ys];
}

export function shown(value) {
  return value == null ? "-" : String(Number(value.toPrecision(6)));
}

export function axis(label, values) {
  return {
    label,
    labelSize: 26,
    size: values,
    stroke: () => colour("--text"),
    grid: { stroke: () => colour("--line"), width: 1 },
    ticks: { stroke: () => colour("--line"), width: 1 },
    font: "12px DejaVu Sans, sans-serif",
    labelFont: "13px DejaVu Sans, sans-serif",
  };
}

/** \param readout element that shows the values at the pointer, or null */
function optionsOf(chart, width, figure, readout) {
  return {
    width,
    height: HEIGHT,
    scales: { x: { time: false }, y: {} },
    axes: [axis(chart.x_label, 46), axis(chart.y_label, 62)],
    cursor: { drag: { x: true, y: false }, focus: { prox: 30 } },
    legend: { live: true, show: !chart.legend },
    series: [
      { label: chart.x_label, value: (_, v) => shown(v) },
      ...chart.series.map((s, i) => ({
        label: s.label,
        ...strokeOf(chart, s, i),
        width: s.line && s.x.length <= MAX_MARKERS ? 1.2 : 2,
        ...(s.line ? {} : { paths: () => null }),
        points: { show: !s.line || s.x.length <= MAX_MARKERS, size: 5 },
        spanGaps: true,
        value: (plot, v, series, at) => shown(v == null && at != null && s.line ? interpolated(plot, series, at) : v),
      })),
    ],
    hooks: {
      setCursor: [
        (plot) => {
          const i = plot.cursor.idx;
          figure.dataset.at = i == null ? "" : plot.data.map((values) => shown(values[i])).join(" ");
          if (readout) readout.textContent = i == null ? "" : nearestText(plot, i);
        },
      ],
      setScale: [
        (plot, key) => {
          if (key === "x") figure.dataset.zoom = `${plot.scales.x.min} ${plot.scales.x.max}`;
        },
      ],
    },
  };
}

/** Returns a text with the value of the curve that is nearest to the pointer. */
function nearestText(plot, i) {
  const y = plot.posToVal(plot.cursor.top, "y");
  let best = { distance: Infinity, text: "" };
  for (let k = 1; k < plot.series.length; ++k) {
    const value = interpolated(plot, k, i);
    if (value == null || Math.abs(value - y) >= best.distance) continue;
    best = { distance: Math.abs(value - y), text: `${plot.series[k].label}: ${shown(value)} at ${shown(plot.data[0][i])}` };
  }
  return best.text;
}

/**
 * Adds a legend for groups of curves, a colour bar and the values at the pointer. Returns a function that draws them in
 * the colours of the theme.
 */
function addLegend(figure, chart, readout) {
  const box = document.createElement("div");
  box.className = "curve-legend";
  const samples = chart.legend.map((key) => {
    const item = document.createElement("span");
    const line = document.createElement("canvas");
    line.width = 34;
    line.height = 12;
    item.append(line, ` ${key.label}`);
    box.append(item);
    return { line, look: key.look };
  });
  const bar = document.createElement("i");
  if (chart.scale) {
    const item = document.createElement("span");
    item.append(`${chart.scale.label}: ${shown(chart.scale.low)} `, bar, ` ${shown(chart.scale.high)}`);
    box.append(item);
  }
  box.append(readout);
  figure.querySelector(".plot").after(box);
  return () => {
    const stops = Array.from({ length: 17 }, (_, k) => scaleColour(k / 16));
    bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    for (const { line, look } of samples) {
      const pen = line.getContext("2d");
      pen.clearRect(0, 0, line.width, line.height);
      pen.strokeStyle = chart.scale ? colour("--text") : curveColour(look);
      pen.lineWidth = 2;
      pen.setLineDash(dashesOf(look, Boolean(chart.scale)));
      pen.beginPath();
      pen.moveTo(0, line.height / 2);
      pen.lineTo(line.width, line.height / 2);
      pen.stroke();
    }
  };
}

/** Adds keys: arrow keys move along the curve, + and - zoom around the current point, 0 shows the complete chart. */
export function addKeys(plot, figure, spoken) {
  const area = figure.querySelector(".plot");
  let at = 0;
  const whole = () => [plot.data[0][0], plot.data[0][plot.data[0].length - 1]];
  const show = () => {
    const x = plot.data[0][at];
    plot.setCursor({ left: plot.valToPos(x, "x"), top: 20 });
    spoken.textContent = plot.series
      .map((s, i) => `${s.label}: ${shown(i === 0 ? plot.data[0][at] : interpolated(plot, i, at))}`)
      .join("; ");
  };
  const zoom = (factor) => {
    const { min, max } = plot.scales.x;
    const x = plot.data[0][at];
    const [low, high] = whole();
    plot.setScale("x", { min: Math.max(low, x - (x - min) * factor), max: Math.min(high, x + (max - x) * factor) });
  };
  area.addEventListener("keydown", (event) => {
    const last = plot.data[0].length - 1;
    if (event.key === "ArrowRight") at = Math.min(last, at + 1);
    else if (event.key === "ArrowLeft") at = Math.max(0, at - 1);
    else if (event.key === "Home") at = 0;
    else if (event.key === "End") at = last;
    else if (event.key === "+") zoom(0.5);
    else if (event.key === "-") zoom(2);
    else if (event.key === "0") {
      const [min, max] = whole();
      plot.setScale("x", { min, max });
    } else return;
    event.preventDefault();
    show();
  });
}

/** Draws a chart. Returns a function that draws it again in the colours of the theme. */
function draw(figure, chart) {
  const area = figure.querySelector(".plot");
  area.tabIndex = 0;
  area.setAttribute("role", "application");
  area.setAttribute("aria-label", `${chart.title}. Arrow keys read the values, plus and minus zoom, 0 shows all.`);
  const spoken = document.createElement("p");
  spoken.className = "spoken";
  spoken.setAttribute("aria-live", "polite");
  figure.append(spoken);
  const readout = chart.legend ? document.createElement("output") : null;
  const widthOf = () => Math.max(280, Math.floor(area.clientWidth));
  const plot = new uPlot(optionsOf(chart, widthOf(), figure, readout), aligned(chart.series), area);
  const drawLegend = chart.legend ? addLegend(figure, chart, readout) : () => recolourLegend(plot);
  if (chart.legend) drawLegend();
  addKeys(plot, figure, spoken);
  const fit = () => {
    if (widthOf() !== plot.width) plot.setSize({ width: widthOf(), height: HEIGHT });
  };
  new ResizeObserver(fit).observe(area);
  window.addEventListener("beforeprint", () => plot.setSize(PRINTED));
  window.addEventListener("afterprint", fit);
  return () => {
    plot.redraw(false, true);
    drawLegend();
  };
}

/** Draws the legend of uPlot in the colours of the theme. */
function recolourLegend(plot) {
  const markers = plot.root.querySelectorAll(".u-marker"); // the first one belongs to the x axis
  markers.forEach((marker, i) => i > 0 && (marker.style.borderColor = curveColour(i - 1)));
}

export function drawCharts(charts) {
  const redraws = [];
  for (const figure of document.querySelectorAll("figure[data-chart]"))
    redraws.push(draw(figure, charts[Number(figure.dataset.chart)]));
  return () => redraws.forEach((redraw) => redraw());
}
