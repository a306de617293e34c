// Determines the daytime colour of a transparent body from its absorption, using the colour names of photometric
// standards.

const NM = { blue: 450, green: 530, yellow: 585, red: 640 };
// Minimum transmittance at which light of a colour counts as transmitted, as a fraction of the largest transmittance.
const PASSES = 0.5;

/**
 * Returns the absorption at a wavelength by linear interpolation. Outside the curve, the value at the nearest end is
 * used.
 */
function absorptionAt(curve, nm) {
  const above = curve.findIndex(([at]) => at >= nm);
  if (above === 0) return curve[0][1];
  if (above < 0) return curve[curve.length - 1][1];
  const [[low, a], [high, b]] = [curve[above - 1], curve[above]];
  return a + ((b - a) * (nm - low)) / (high - low);
}

/** Returns the absorption of a body as a list of [wavelength, absorption], or null if it is the same for all colours. */
function absorptionOf(design) {
  const absorption = design && design.keys.find(({ path }) => path === "body.absorption_per_mm");
  return absorption && Array.isArray(absorption.value) ? absorption.value : null;
}

/** Returns the path length of light through the body in mm: twice the thickness. */
function pathLengthOf(design) {
  return 2 * (design.thickness_mm || 1);
}

/**
 * Returns the colour in which drawings show the body, such as "rgb(230, 150, 40)". It is null for clear bodies. The colour
 * is that of white light after two passes, made so light that edges and light paths remain visible.
 */
export function tintOf(design) {
  const curve = absorptionOf(design);
  if (!curve || coloursOf(design)[0] === "white") return null;
  const path_mm = pathLengthOf(design);
  const passed = [NM.red, NM.green, NM.blue].map((nm) => Math.exp(-path_mm * absorptionAt(curve, nm)));
  const max = Math.max(...passed, 1e-12);
  return `rgb(${passed.map((t) => Math.round(40 + 195 * (t / max))).join(", ")})`;
}

/**
 * Returns the possible names of the body's colour, the best match first. A body without spectral absorption is clear
 * ("white").
 */
export function coloursOf(design) {
  const curve = absorptionOf(design);
  if (!curve) return ["white"];
  const path_mm = pathLengthOf(design);
  const least = Math.min(...Object.values(NM).map((nm) => absorptionAt(curve, nm)));
  const passes = (nm) => Math.exp(path_mm * (least - absorptionAt(curve, nm))) >= PASSES;
  const [blue, green, yellow, red] = Object.values(NM).map(passes);
  if (red && !yellow) return ["red"];
  if (red && !green) return ["amber", "orange", "yellow"];
  if (red && !blue) return ["yellow", "amber"];
  if (red) return ["white"];
  return green || yellow ? ["green"] : ["blue"];
}
