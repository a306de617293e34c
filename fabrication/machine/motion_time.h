#pragma once

// Computes the time of moves that start and end at rest.

#include <limits>

#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Maximum speed, acceleration and jerk along a path or of one axis. Units are mm or degrees, and seconds.
struct MotionLimits {
  double speed = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();
};

/// Travel of all axes in one move.
struct AxisTravel {
  geometry::Vec3 linear_mm = geometry::Vec3::Zero();  ///< travel of X, Y and Z
  double tilt_deg = 0.0;                              ///< rotation of the tilting axis (A or B)
  double c_deg = 0.0;                                 ///< rotation of C

  /// Returns the path length to which a feed refers: in mm, or in degrees if only rotary axes move.
  double length() const;
};

/// Returns the minimum time, in s, of a motion over a distance that starts and ends at rest. The jerk is piecewise
/// constant, or the acceleration is constant if there is no jerk limit (docs/theory/cutting.md).
/// \pre distance >= 0, limits > 0
double rest_to_rest_s(double distance, const MotionLimits& limits);

/// Returns the time, in s, of a rapid move, without settling. If Control::rapids_are_straight is false, each axis moves
/// at its own speed, and the result is the time of the slowest axis. Otherwise, all axes start and end together on a
/// straight line. The speed along this line is then limited by the axis that permits the lowest speed. The same rule
/// applies to acceleration and jerk.
double rapid_motion_s(const Machine& machine, const AxisTravel& by);

/// Returns the time, in s, of a move at a feed, without settling. All axes start and end together on a straight line.
/// No axis exceeds its maximum feed (linear axes) or speed (rotary axes).
/// \param feed_per_min feed along AxisTravel::length(), in mm/min or degrees/min
double fed_motion_s(const Machine& machine, const AxisTravel& by, double feed_per_min);

}  // namespace retrace::fabrication
