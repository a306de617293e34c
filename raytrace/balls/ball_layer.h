#pragma once

// What a ball retroreflector is: diameter, mirror, spacer and pitch.

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/angle.h"

namespace retrace::raytrace {

/// Balls of glass sunk to their equator, with a mirror behind: elements of lens and mirror. The centres lie on z = 0,
/// and what lies between the balls on that plane is black. A ball's own back can be the mirror, or a bowl that is
/// concentric with it, with a clear spacer between.
struct BallLayer {
  double diameter_mm = 0.0;             ///< > 0
  double mirror_offset_mm = 0.0;        ///< from the ball to the bowl; 0: the ball's own back is coated
  double mirror_half_angle_deg = 90.0;  ///< how far the mirror reaches from -z, seen from the ball's centre; to 90
  std::optional<double> pitch_mm;       ///< of an endless hexagonal layer, >= diameter_mm; none: a single ball

  double radius_mm() const { return 0.5 * diameter_mm; }
  double mirror_radius_mm() const { return radius_mm() + mirror_offset_mm; }
  /// How far a mirror can reach before the bowls of neighbours meet.
  double most_mirror_half_angle_deg() const {
    if (!pitch_mm || mirror_offset_mm <= 0.0) return 90.0;
    return Angle::from_rad(std::asin(std::min(1.0, 0.5 * *pitch_mm / mirror_radius_mm()))).deg();
  }
};

}  // namespace retrace::raytrace
