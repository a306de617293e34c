#pragma once

// How long the axes of a machine take from a standstill to a standstill.

#include <limits>

#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Limits of a motion along a path, or of one axis, in mm or degrees and seconds.
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

  /// Returns the length of the path along which the feed counts: in mm, or in degrees if only rotary axes move.
  double length() const;
};

/// The shortest time from rest to rest over a distance: jerk that is constant piece by piece, or constant acceleration
/// where jerk has no limit (docs/theory/cutting.md). \pre distance >= 0, limits > 0
double rest_to_rest_s(double distance, const MotionLimits& limits);

/// Returns the time, in s, of a rapid move, without settling. If Control::rapids_are_straight is false, each axis moves
/// at its own speed and the slowest axis counts. Otherwise all axes start and end together on a straight line, so that
/// speed, acceleration and jerk along the line are each limited by the axis that limits them most.
double rapid_motion_s(const Machine& machine, const AxisTravel& by);

/// Returns the time, in s, of a move at a feed, without settling. All axes start and end together on a straight line,
/// within the maximum feeds of the linear axes and the speeds of the rotary axes.
/// \param feed_per_min feed along AxisTravel::length(), in mm/min or degrees/min
double fed_motion_s(const Machine& machine, const AxisTravel& by, double feed_per_min);

}  // namespace retrace::fabrication
