#pragma once

// Converts between directions and pairs of angles from the direction to the source. The two angles, to the right and
// upwards, are the coordinates of far fields and angular maps.

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Axes for directions around the direction to the source. A direction is described by two angles, to the right and
/// upwards. Their norm is the angle from the direction to the source, the observation angle (azimuthal equidistant
/// projection).
struct ReturnFrame {
  geometry::Vec3 to_source = geometry::Vec3::UnitZ();
  geometry::Vec3 right = geometry::Vec3::UnitX(), up = geometry::Vec3::UnitY();

  geometry::Vec2 angles_rad(const geometry::Vec3& direction) const {
    const geometry::Vec2 across(direction.dot(right), direction.dot(up));
    const double sine = across.norm();
    if (sine == 0.0) return {direction.dot(to_source) < 0.0 ? EIGEN_PI : 0.0, 0.0};
    return across * (std::atan2(sine, direction.dot(to_source)) / sine);
  }

  geometry::Vec3 direction(const geometry::Vec2& angles_rad) const {
    const double angle = angles_rad.norm();
    if (angle == 0.0) return to_source;
    const double factor = std::sin(angle) / angle;
    return (std::cos(angle) * to_source + factor * (angles_rad.x() * right + angles_rad.y() * up)).normalized();
  }
};

}  // namespace retrace::raytrace
