// Interactive charts for pointer and keyboard, drawn with uPlot.
import uPlot from "uplot";
import { colour } from "./theme.js";

const WIDTHS = [2, 2, 2, 2, 2, 2, 2];

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

function optionsOf(chart, width, figure) {
  return {
    width,
    height: 340,
    scales: { x: { time: false }, y: {} },
    axes: [axis(chart.x_label, 46), axis(chart.y_label, 62)],
    cursor: { drag: { x: true, y: false }, focus: { prox: 30 } },
    legend: { live: true },
    series: [
      { label: chart.x_label, value: (_, v) => shown(v) },
      ...chart.series.map((s, i) => ({
        label: s.label,
        stroke: () => colour(`--curve-${i % 7}`),
        width: WIDTHS[i % 7],
        dash: i < 7 ? undefined : [6, 4],
        ...(s.line ? {} : { paths: () => null }),
        points: { show: !s.line || s.x.length < 60, size: 5 },
        spanGaps: true,
        value: (_, v) => shown(v),
      })),
    ],
    hooks: {
      setCursor: [
        (plot) => {
          const i = plot.cursor.idx;
          figure.dataset.at = i == null ? "" : plot.data.map((values) => shown(values[i])).join(" ");
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

/** Adds keys: arrow keys move along the curve, + and - zoom around the current point, 0 shows the complete chart. */
export function addKeys(plot, figure, spoken) {
  const area = figure.querySelector(".plot");
  let at = 0;
  const whole = () => [plot.data[0][0], plot.data[0][plot.data[0].length - 1]];
  const show = () => {
    const x = plot.data[0][at];
    plot.setCursor({ left: plot.valToPos(x, "x"), top: 20 });
    spoken.textContent = plot.series
      .map((s, i) => `${s.label}: ${shown(plot.data[i][at])}`)
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

function draw(figure, chart) {
  const area = figure.querySelector(".plot");
  area.tabIndex = 0;
  area.setAttribute("role", "application");
  area.setAttribute("aria-label", `${chart.title}. Arrow keys read the values, plus and minus zoom, 0 shows all.`);
  const spoken = document.createElement("p");
  spoken.className = "spoken";
  spoken.setAttribute("aria-live", "polite");
  figure.append(spoken);
  const plot = new uPlot(optionsOf(chart, Math.max(280, area.clientWidth), figure), aligned(chart.series), area);
  addKeys(plot, figure, spoken);
  new ResizeObserver(() => {
    const width = Math.max(280, Math.floor(area.clientWidth));
    if (width !== plot.width) plot.setSize({ width, height: 340 });
  }).observe(area);
  return plot;
}

export function drawCharts(charts) {
  const plots = [];
  for (const figure of document.querySelectorAll("figure[data-chart]"))
    plots.push(draw(figure, charts[Number(figure.dataset.chart)]));
  return () => plots.forEach((plot) => plot.redraw(false, true));
}
