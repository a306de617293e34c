#pragma once

// Coefficients of retroreflection of CIE 54.2 and ASTM E808 (R_A, R_L) from intensities.

#include <cmath>

#include "core/angle.h"

namespace retrace::raytrace {

/// The following coefficients are computed from the intensity towards the receiver, divided by the flux on the entrance
/// face of the part. This flux is the illuminance perpendicular to the beam times the projected area A cos(beta).

/// Returns R_A, the coefficient of retroreflection, in cd/(lx m^2): intensity divided by illuminance and area of the
/// part.
inline double coefficient_of_retroreflection(double intensity_per_sr, Angle entrance_angle) {
  return intensity_per_sr * std::cos(entrance_angle.rad());
}

/// Returns R_L, the coefficient of retroreflected luminance, in cd/(lx m^2): luminance towards the receiver divided by
/// the illuminance.
/// \param viewing_angle angle between the normal and the direction to the receiver
inline double coefficient_of_luminance(double coefficient_of_retroreflection, Angle viewing_angle) {
  return coefficient_of_retroreflection / std::cos(viewing_angle.rad());
}

}  // namespace retrace::raytrace
