#pragma once

// Formulas for vectors and segments in the plane.

#include <algorithm>

#include "geometry/vec.h"

namespace retrace::geometry::plane {

/// Returns the z component of the cross product.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Returns the vector rotated by 90 degrees counter-clockwise.
inline Vec2 left_of(const Vec2& v) {
  return {-v.y(), v.x()};
}

/// Returns the distance between a point and the segment from a to b.
inline double distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double fraction = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - fraction * along).norm();
}

}  // namespace retrace::geometry::plane
