#pragma once

// How long the axes of a machine take from a standstill to a standstill.

#include <limits>

#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Of a motion along a line, or of one axis, in mm or degrees and seconds.
struct MotionLimits {
  double speed = std::numeric_limits<double>::infinity();
  double acceleration = std::numeric_limits<double>::infinity();
  double jerk = std::numeric_limits<double>::infinity();
};

/// Of a motion along a line in space by (x, y, z) mm: what the axes allow together. Its speed is left open.
MotionLimits limits_along(const Machine& machine, const geometry::Vec3& by_mm);

/// The shortest time from rest to rest over a distance: jerk that is constant piece by piece, or constant acceleration
/// where jerk has no limit (docs/theory/cutting.md). \pre distance >= 0, limits > 0
double rest_to_rest_s(double distance, const MotionLimits& limits);

/// Returns the time, in s, of a rapid move by (x, y, z) mm, without settling. This is the time of the slowest axis, or
/// the time along the straight line if Control::rapids_are_straight is true.
double rapid_motion_s(const Machine& machine, const geometry::Vec3& by_mm);

/// Returns the time, in s, of a simultaneous move of the tilting axis (A or B) and C, without settling.
/// \param deg_per_min feed along the common path of both axes
double fed_rotary_motion_s(const Machine& machine, double tilt_deg, double c_deg, double deg_per_min);

/// By A or B and by C, in degrees, each as fast as it goes and both to be waited for; without settling.
double rotary_motion_s(const Machine& machine, double tilt_deg, double c_deg);

}  // namespace retrace::fabrication
