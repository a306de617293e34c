// The colour of a body by daylight, in the words of standards.

const NM = { blue: 450, green: 530, yellow: 585, red: 640 };
const PASSES = 0.5; // fraction of the greatest transmittance

/** Returns the absorption at a wavelength; outside of the curve it is that of the nearest end. */
function absorptionAt(curve, nm) {
  const above = curve.findIndex(([at]) => at >= nm);
  if (above === 0) return curve[0][1];
  if (above < 0) return curve[curve.length - 1][1];
  const [[low, a], [high, b]] = [curve[above - 1], curve[above]];
  return a + ((b - a) * (nm - low)) / (high - low);
}

/** Names of the body's colour, the best one first. A body without a spectral absorption is clear. */
export function coloursOf(design) {
  const absorption = design && design.keys.find(({ path }) => path === "body.absorption_per_mm");
  if (!absorption || !Array.isArray(absorption.value)) return ["white"];
  const path_mm = 2 * (design.thickness_mm || 1); // in and back out
  const least = Math.min(...Object.values(NM).map((nm) => absorptionAt(absorption.value, nm)));
  const passes = (nm) => Math.exp(path_mm * (least - absorptionAt(absorption.value, nm))) >= PASSES;
  const [blue, green, yellow, red] = Object.values(NM).map(passes);
  if (red && !yellow) return ["red"];
  if (red && !green) return ["amber", "orange", "yellow"];
  if (red && !blue) return ["yellow", "amber"];
  if (red) return ["white"];
  return green || yellow ? ["green"] : ["blue"];
}
