// Finds directions of light that are equivalent by symmetry of the design. Only one of them is traced.

function turned(azimuth_deg) {
  return ((azimuth_deg % 360) + 360) % 360;
}

/** Returns the azimuth that represents all equivalent azimuths. */
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

/**
 * Returns the name of the direction that is traced instead of the given direction.
 * \param symmetry symmetry of the design, or null
 */
export function nameOf(incidence_deg, azimuth_deg, symmetry) {
  const azimuth = incidence_deg < 0 ? azimuth_deg + 180 : azimuth_deg;
  const at = incidence_deg === 0 && symmetry ? 0 : representative(azimuth, symmetry);
  return `${Math.abs(incidence_deg)} ${Number(at.toFixed(6))}`;
}

/** Returns incidence and azimuth from a name. */
export function directionOf(name) {
  return name.split(" ").map(Number);
}
