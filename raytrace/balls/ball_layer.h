#pragma once

// Parameters of a ball retroreflector: diameter, mirror, spacer and pitch.

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/angle.h"

namespace retrace::raytrace {

/// Glass balls that are embedded up to their equator, with a mirror behind each ball. The centres are on the plane z =
/// 0. The area between the balls on this plane is black. The mirror is either the coated back of the ball, or a
/// concentric bowl with a transparent spacer between ball and bowl.
struct BallLayer {
  double diameter_mm = 0.0;             ///< > 0
  double mirror_offset_mm = 0.0;        ///< distance from the ball to the bowl; 0 if the back of the ball is coated
  double mirror_half_angle_deg = 90.0;  ///< angle between -z and the mirror's edge, seen from the ball's centre; <= 90
  std::optional<double> pitch_mm;       ///< pitch of an infinite hexagonal layer, >= diameter_mm; none: a single ball

  double radius_mm() const { return 0.5 * diameter_mm; }
  double mirror_radius_mm() const { return radius_mm() + mirror_offset_mm; }
  /// Returns the maximum half angle of a mirror, at which the bowls of adjacent balls touch.
  double max_mirror_half_angle_deg() const {
    if (!pitch_mm || mirror_offset_mm <= 0.0) return 90.0;
    return Angle::from_rad(std::asin(std::min(1.0, 0.5 * *pitch_mm / mirror_radius_mm()))).deg();
  }
};

}  // namespace retrace::raytrace
