#pragma once

// Vectors of the plane and of space, from Eigen.

#include <Eigen/Core>

namespace retrace::geometry {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

}  // namespace retrace::geometry
