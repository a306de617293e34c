#pragma once

// The angle between directions, to all digits where it is small.

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// \pre unit vectors
inline double small_angle_between(const geometry::Vec3& a, const geometry::Vec3& b) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * (a - b).norm()));
}

}  // namespace retrace::raytrace
