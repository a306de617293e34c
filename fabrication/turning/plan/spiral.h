#pragma once

// Spirals as functions: position of the tool as a function of the spindle angle, and spindle angle as a function of
// time.

#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// Positions of the tool along a spiral, as a function of the spindle's angle.
class ToolSpiral {
 public:
  ToolSpiral(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& options);

  /// Returns the number of turns from the start to the spindle's axis.
  double total_turns() const { return start_mm_ / feed_mm_; }
  double radius_mm(double turns) const { return start_mm_ - feed_mm_ * turns; }
  /// Returns a point of the spiral, without its time.
  /// \param touch_rad angle on the nose at which the search starts; receives the angle of the point of contact
  PathPoint at(double turns, double& touch_rad) const;
  double end_rad() const { return nose_.end_rad(); }

 private:
  NoseCompensation nose_;
  double start_mm_;
  double feed_mm_;
  double skew_rad_;
};

/// Rotation of C that accelerates uniformly from rest to the speed of the spindle, and decelerates to rest at the end.
class SpindleMotion {
 public:
  /// \param whole_deg total angle of the rotation
  SpindleMotion(double whole_deg, double speed_deg_per_s, double acceleration_deg_per_s2);

  double total_s() const { return total_s_; }
  double time_s(double c_deg) const;
  double c_deg(double time_s) const;
  double speed_deg_per_s(double time_s) const;
  double ramp_s() const { return speed_ / acceleration_; }
  /// Returns a slightly slower rotation. Its ramps (acceleration and deceleration), and the motion between them, take
  /// whole numbers of steps.
  SpindleMotion in_whole_steps(double step_s) const;

 private:
  double total_deg_;
  double acceleration_;
  double speed_;
  double total_s_;
};

/// Returns the angle of the spindle, in turns, between neighbouring points of the straight path at a radius. There are
/// at least 24 points per turn, because equal arc lengths would give too few points near the centre.
double turns_between_points(const PathOptions& options, double radius_mm);

}  // namespace retrace::fabrication::turning
