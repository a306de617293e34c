// Ranges of the sliders. They are useful ranges, not the allowed ranges.

const BY_NAME = {
  apex_angle_deg: [80, 100],
  cant_deg: [0, 20],
  refractive_index: [1.3, 2],
  back_index: [1, 2],
  wavelength_nm: [400, 700],
  acceptance_half_angle_deg: [0.1, 5],
  temperature_c: [-40, 80],
  dihedral_error_arcmin: [-30, 30],
  dihedral_error_arcsec: [-10, 10],
  facet_tilt_arcmin: [-30, 30],
  mask_threshold: [0, 1],
  edge_chords: [4, 64],
  sink_um: [-5, 5],
  index: [1, 2],
  incline_deg: [0, 30],
};
const BY_UNIT = {
  per_mm: [0, 0.1],
  arcmin: [0, 30],
  percent: [0, 99],
  um: [0, 50],
  nm: [0, 200],
};
const NO_SLIDER = /_seed$|^seed$/;
const STEPS = 200;

/** Returns the step (1, 2 or 5 times a power of ten) that divides a range into about 200 steps. */
function niceStep(range) {
  const decade = 10 ** Math.floor(Math.log10(range / STEPS));
  return decade * [1, 2, 5, 10].find((f) => f * decade >= range / STEPS - 1e-15);
}

/**
 * Returns the range for a length: from 0 to a multiple of the value. For the value 0, the range ends at the size of an
 * element.
 */
function roundLength(value, size_mm) {
  if (value > 0) return [0, 2.5 * value];
  return [0, size_mm];
}

/**
 * Returns the range and step of a slider, {low, high, step}, or nothing if a slider is not useful.
 * \param row description of the key in the form
 * \param value initial value; may be null
 */
export function sliderOf(row, value, size_mm) {
  if (!["number", "whole"].includes(row.kind) || NO_SLIDER.test(row.name)) return null;
  const suffix = Object.keys(BY_UNIT).find((unit) => row.name.endsWith(`_${unit}`));
  const isAngle = row.name.endsWith("azimuth_deg");
  let range = row.slider || BY_NAME[row.name] || (isAngle ? [-180, 180] : null) || (suffix && BY_UNIT[suffix]);
  if (!range && row.name.endsWith("_mm")) range = roundLength(value, size_mm);
  if (!range && row.low != null && row.high != null && row.high - row.low <= 1000) range = [row.low, row.high];
  if (!range) return null;
  let [low, high] = range;
  if (value != null) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const step = row.kind === "whole" ? 1 : niceStep(high - low);
  low = Math.max(low, row.low ?? -Infinity);
  high = Math.min(high, row.high ?? Infinity);
  if (row.low_included === false && low <= row.low) low = row.low + step;
  if (row.high_included === false && high >= row.high) high = row.high - step;
  low = Math.ceil(low / step - 1e-9) * step;
  return high > low ? { low, high, step } : null;
}

/** Rounds a slider value to remove floating-point errors of its steps. */
export function clean(value, step) {
  const digits = Math.max(0, Math.ceil(-Math.log10(step)) + 1);
  return Number(value.toFixed(Math.min(12, digits)));
}
