#pragma once

// Haze as defined by ASTM D1003: light that is scattered by more than 2.5 degrees.

#include <cmath>

#include "core/angle.h"

namespace retrace::design {

inline constexpr double kHazeAngleDeg = 2.5;

/// Returns the fraction of a Gaussian lobe around the normal, exp(-(sin t / sin spread)^2), that is outside of the haze
/// angle.
inline double beyond_haze_angle(double spread_deg) {
  const double ratio = std::sin(Angle::from_deg(kHazeAngleDeg).rad()) / std::sin(Angle::from_deg(spread_deg).rad());
  return std::exp(-ratio * ratio);
}

}  // namespace retrace::design
