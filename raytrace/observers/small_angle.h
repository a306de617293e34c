#pragma once

// Angle between two directions, accurate for small angles.

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Returns the angle between two directions, accurate for small angles.
/// \pre both are unit vectors
inline double small_angle_between(const geometry::Vec3& a, const geometry::Vec3& b) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * (a - b).norm()));
}

}  // namespace retrace::raytrace
