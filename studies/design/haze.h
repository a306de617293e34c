#pragma once

// Haze as ASTM D1003 tells it: what leaves beyond 2.5 degrees.

#include <cmath>

#include "core/angle.h"

namespace retrace::studies {

inline constexpr double kHazeAngleDeg = 2.5;

/// Share of a Gaussian lobe round the normal, exp(-(sin t / sin spread)^2), that lies beyond that angle.
inline double beyond_haze_angle(double spread_deg) {
  const double ratio = std::sin(Angle::from_deg(kHazeAngleDeg).rad()) / std::sin(Angle::from_deg(spread_deg).rad());
  return std::exp(-ratio * ratio);
}

}  // namespace retrace::studies
