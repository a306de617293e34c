#pragma once

// Coefficients of retroreflection of CIE 54.2 and ASTM E808 (R_A, R_L) from intensities.

#include <cmath>

#include "core/angle.h"

namespace retrace::raytrace {

/// Retroreflection as CIE 54.2 and ASTM E808 count it, from the intensity per steradian that a part sends towards the
/// receiver per unit of the flux on its entrance face. That flux is the illuminance across the beam times the area seen
/// along it, A cos(beta).

/// R_A, coefficient of retroreflection, in cd/(lx m^2): intensity over that illuminance and the area of the part.
inline double coefficient_of_retroreflection(double intensity_per_sr, Angle entrance_angle) {
  return intensity_per_sr * std::cos(entrance_angle.rad());
}

/// R_L, coefficient of retroreflected luminance, in cd/(lx m^2): luminance in the direction of the receiver over that
/// illuminance. \param viewing_angle between the normal and that direction
inline double coefficient_of_luminance(double coefficient_of_retroreflection, Angle viewing_angle) {
  return coefficient_of_retroreflection / std::cos(viewing_angle.rad());
}

}  // namespace retrace::raytrace
