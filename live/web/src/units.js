// Formats names and numbers for display.

const SUFFIXES = [
  ["_per_mm", "1/mm"],
  ["_arcmin", "′"],
  ["_arcsec", "″"],
  ["_percent", "%"],
  ["_deg", "°"],
  ["_mm", "mm"],
  ["_um", "µm"],
  ["_nm", "nm"],
  ["_c", "°C"],
];

/** Splits a key into label and unit: "apex_angle_deg" becomes "apex angle" and "°". */
export function named(key) {
  for (const [suffix, unit] of SUFFIXES)
    if (key.endsWith(suffix)) return { label: key.slice(0, -suffix.length).replaceAll("_", " "), unit };
  return { label: key.replaceAll("_", " "), unit: "" };
}

export function words(name) {
  return name.replaceAll("_", " ");
}

/** Returns the shortest text of a number with a given number of significant digits. */
export function short(value, digits = 4) {
  return value == null ? "–" : String(Number(value.toPrecision(digits))).replace("-", "−");
}

export function percent(fraction, decimals = 2) {
  return fraction == null ? "–" : `${(100 * fraction).toFixed(decimals).replace("-", "−")} %`;
}

/** Formats an angle in degrees, or in minutes or seconds of arc if it is small. */
export function angle(deg) {
  if (deg === 0) return "0°";
  const size = Math.abs(deg);
  if (size < 1e-6) return "0°";
  if (size < 1 / 60) return `${short(3600 * deg, 3)}″`;
  return size < 0.5 ? `${short(60 * deg, 3)}′` : `${short(deg, 4)}°`;
}
