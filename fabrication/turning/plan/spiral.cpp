#include "fabrication/turning/plan/spiral.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace retrace::fabrication::turning {

using geometry::Vec2;

ToolSpiral::ToolSpiral(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& o)
    : nose_(surface, tool, SingleContactMap(surface, tool, o.radius_mm + o.overrun_mm)),
      start_mm_(o.radius_mm + o.overrun_mm),
      feed_mm_(o.feed_mm),
      skew_rad_(tool.skew_deg * kRadPerDeg) {}

PathPoint ToolSpiral::at(double turns, double& touch_rad) const {
  const double r = radius_mm(turns);
  const double c = kTwoPi * (turns - std::floor(turns));
  const Vec2 across(std::cos(c), -std::sin(c));
  const Vec2 cut(-std::sin(c), -std::cos(c));
  PathPoint p;
  p.x_mm = r * std::cos(skew_rad_);
  p.y_mm = skew_rad_ == 0.0 ? 0.0 : -r * std::sin(skew_rad_);
  p.c_deg = 360.0 * turns;
  const Vec2 tip = p.x_mm * across - p.y_mm * cut;
  p.z_mm = nose_.height_mm(tip.x(), tip.y(), across, cut, touch_rad);
  return p;
}

SpindleMotion::SpindleMotion(double whole_deg, double speed_deg_per_s, double acceleration)
    : total_deg_(whole_deg),
      acceleration_(acceleration),
      speed_(std::min(speed_deg_per_s, std::sqrt(acceleration * whole_deg))),
      total_s_(whole_deg / speed_ + ramp_s()) {}

double SpindleMotion::time_s(double c_deg) const {
  const double ramp = 0.5 * speed_ * ramp_s();
  if (c_deg < ramp) return std::sqrt(2.0 * std::max(0.0, c_deg) / acceleration_);
  if (c_deg > total_deg_ - ramp) return total_s_ - std::sqrt(2.0 * std::max(0.0, total_deg_ - c_deg) / acceleration_);
  return ramp_s() + (c_deg - ramp) / speed_;
}

double SpindleMotion::c_deg(double time_s) const {
  const double before = std::max(0.0, time_s);
  const double left = std::max(0.0, total_s_ - time_s);
  if (before < ramp_s()) return 0.5 * acceleration_ * before * before;
  if (left < ramp_s()) return total_deg_ - 0.5 * acceleration_ * left * left;
  return speed_ * (before - 0.5 * ramp_s());
}

double SpindleMotion::speed_deg_per_s(double time_s) const {
  return std::min(speed_, acceleration_ * std::max(0.0, std::min(time_s, total_s_ - time_s)));
}

SpindleMotion SpindleMotion::in_whole_steps(double step_s) const {
  const auto whole_steps = [&](double seconds) { return step_s * std::ceil(seconds / step_s - 1e-9); };
  const double ramp = whole_steps(ramp_s());
  const double even = whole_steps(std::max(0.0, total_s_ - 2.0 * ramp_s()));
  const double speed = total_deg_ / (ramp + even);
  return {total_deg_, speed, speed / ramp};
}

double turns_between_points(const PathOptions& o, double radius_mm) {
  if (o.sampling == Sampling::angle) return 1.0 / o.points_per_turn;
  constexpr double kMaxStep = 1.0 / 24.0;
  return std::min(kMaxStep, o.arc_mm / (kTwoPi * radius_mm));
}

}  // namespace retrace::fabrication::turning
