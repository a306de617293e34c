#pragma once

// Computes directions and rotations from angles. Sines and cosines come from sin_cos(), which is exact at multiples of
// 90 degrees. Directions along the coordinate axes are therefore exact.

#include "core/sin_cos.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Returns the unit vector in the xy plane at an azimuth, counted from +x towards +y.
inline Vec2 direction_at(Angle azimuth) {
  const auto [sine, cosine] = sin_cos(azimuth);
  return {cosine, sine};
}

/// Returns the unit vector at the angle `from_z` from +z. The azimuth is counted from +x towards +y.
inline Vec3 direction_at(Angle from_z, Angle azimuth) {
  const auto [sine, cosine] = sin_cos(from_z);
  const Vec2 plan = sine * direction_at(azimuth);
  return Vec3(plan.x(), plan.y(), cosine).normalized();
}

/// Returns the matrix of a right-handed rotation about a unit vector (Rodrigues' formula).
inline Eigen::Matrix3d rotation_about(const Vec3& axis, Angle angle) {
  const auto [sine, cosine] = sin_cos(angle);
  Eigen::Matrix3d across;
  across << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return cosine * Eigen::Matrix3d::Identity() + sine * across + (1.0 - cosine) * axis * axis.transpose();
}

}  // namespace retrace::geometry
