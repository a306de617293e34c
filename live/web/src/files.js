// Saves files and copies text to the clipboard.
import { colour } from "../../../report/page/web/src/theme.js";

export function save(name, type, content) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Copies text to the clipboard. Returns false if the browser refuses, for example if the page was opened from disk. */
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch (error) {
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
}

export function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
}

function quoted(text) {
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/**
 * Returns the curves as CSV.
 * \param curves list of {title, rows}
 */
export function curveCsv(curves, azimuth_deg) {
  const lines = ["design,incidence_deg,azimuth_deg,rre,truncated,std_error"];
  for (const { title, rows } of curves)
    for (const { x, rre, truncated, std_error } of rows) lines.push([quoted(title), x, azimuth_deg, rre, truncated, std_error].join(","));
  return `${lines.join("\n")}\n`;
}

function xmlText(text) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");
}

/** Labels of the axes of curves. */
export const CURVE_AXES = { x: "Incidence (°)", y: "RRE (%)" };
const BOX = { left: 64, top: 24, width: 560, height: 320 };

function svgAxes([low, high]) {
  const { left, top, width, height } = BOX;
  const step = high > 45 ? 20 : 10;
  const parts = [];
  for (let y = 0; y <= 100; y += 20) {
    const at = top + height * (1 - y / 100);
    parts.push(`<path class="grid" d="M${left} ${at}H${left + width}"/><text x="${left - 8}" y="${at + 4}" text-anchor="end">${y}</text>`);
  }
  for (let x = Math.ceil(low / step) * step; x <= high; x += step) {
    const at = left + (width * (x - low)) / (high - low);
    parts.push(`<path class="grid" d="M${at} ${top}V${top + height}"/><text x="${at}" y="${top + height + 18}" text-anchor="middle">${x}</text>`);
  }
  parts.push(
    `<text x="${left + width / 2}" y="${top + height + 40}" text-anchor="middle">${CURVE_AXES.x}</text>`,
    `<text transform="translate(18 ${top + height / 2}) rotate(-90)" text-anchor="middle">${CURVE_AXES.y}</text>`,
  );
  return parts.join("\n");
}

/**
 * Returns the curves as an SVG drawing.
 * \param curves list of {title, rows, name of a colour}
 */
export function curveSvg(curves, azimuth_deg, [low, high]) {
  const { left, top, width, height } = BOX;
  const at = ({ x, rre }) => `${(left + (width * (x - low)) / (high - low)).toFixed(2)},${(top + height * (1 - rre)).toFixed(2)}`;
  const lines = curves.map(({ rows, name }, k) => {
    const points = rows.filter(({ x }) => x >= low && x <= high).map(at);
    return `<polyline points="${points.join(" ")}" stroke="${colour(name)}"${k ? ' stroke-dasharray="5 4"' : ""}/>`;
  });
  const legend = curves.map(
    ({ title, name }, k) =>
      `<path d="M${left} ${top + height + 66 + 20 * k}h24" stroke="${colour(name)}" stroke-width="2"/>` +
      `<text x="${left + 32}" y="${top + height + 70 + 20 * k}">${xmlText(title)}, azimuth ${azimuth_deg}°</text>`,
  );
  const total = top + height + 80 + 20 * curves.length;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${left + width + 24} ${total}" font-family="DejaVu Sans, sans-serif" font-size="12">
<style>.grid{stroke:#d7dbe0}text{fill:#1c2026}polyline{fill:none;stroke-width:2}</style>
<rect width="100%" height="100%" fill="#ffffff"/>
${svgAxes([low, high])}
${lines.join("\n")}
${legend.join("\n")}
</svg>
`;
}
