#pragma once

// Spirals as functions: where the tool is by the turns of the spindle, and how far that has turned by the time.

#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// Places of the tool along a spiral, at any angle of the spindle.
class SpiralPlaces {
 public:
  SpiralPlaces(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& options);

  /// Turns from the rim to the spindle's axis.
  double whole_turns() const { return start_mm_ / feed_mm_; }
  double radius_mm(double turns) const { return start_mm_ - feed_mm_ * turns; }
  /// Without its time. \param touch_rad angle on the nose where the search for the touching place starts; where it ends
  PathPoint at(double turns, double& touch_rad) const;
  double end_rad() const { return nose_.end_rad(); }

 private:
  NoseCompensation nose_;
  double start_mm_;
  double feed_mm_;
  double skew_rad_;
};

/// C that goes from a standstill to the spindle's speed and back at an even acceleration.
class SpinTimes {
 public:
  /// \param whole_deg that it turns in all
  SpinTimes(double whole_deg, double speed_deg_per_s, double acceleration_deg_per_s2);

  double whole_s() const { return whole_s_; }
  double time_s(double c_deg) const;
  double c_deg(double time_s) const;
  double speed_deg_per_s(double time_s) const;
  double ramp_s() const { return speed_ / acceleration_; }
  /// The same a little slower, so that both ramps and what is between take whole numbers of steps.
  SpinTimes in_whole_steps(double step_s) const;

 private:
  double whole_;
  double acceleration_;
  double speed_;
  double whole_s_;
};

/// Turns of the spindle from one point of the straight path to the next at that radius: points by equal arcs would be
/// few near the centre, 24 a turn are the fewest.
double turns_between_points(const PathOptions& options, double radius_mm);

}  // namespace retrace::fabrication::turning
