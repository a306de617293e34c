// Directions of the light that mean the same to a design: of those that are alike by its symmetry one is traced.

function turned(azimuth_deg) {
  return ((azimuth_deg % 360) + 360) % 360;
}

/** The azimuth that stands for all that are alike. */
function representative(azimuth_deg, symmetry) {
  let azimuth = turned(azimuth_deg);
  if (!symmetry) return azimuth;
  const period = symmetry.period_deg || 360;
  azimuth = azimuth % period;
  if (symmetry.mirror_deg != null) {
    const across = (((2 * symmetry.mirror_deg - azimuth) % period) + period) % period;
    azimuth = Math.min(azimuth, across);
  }
  return azimuth;
}

/** The name of the direction that is traced for this one. \param symmetry of the design; none: null */
export function nameOf(incidence_deg, azimuth_deg, symmetry) {
  const azimuth = incidence_deg < 0 ? azimuth_deg + 180 : azimuth_deg;
  const at = incidence_deg === 0 && symmetry ? 0 : representative(azimuth, symmetry);
  return `${Math.abs(incidence_deg)} ${Number(at.toFixed(6))}`;
}

/** Incidence and azimuth of a name. */
export function directionOf(name) {
  return name.split(" ").map(Number);
}
