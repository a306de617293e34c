#include "fabrication/machine/motion_time.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace retrace::fabrication {
namespace {

/// From rest to a speed. While acceleration grows and falls without reaching its limit, half of the speed is gained in
/// each half of the time; above that both take acceleration / jerk.
double speeding_up_s(double speed, const MotionLimits& limits) {
  if (speed * limits.jerk < limits.acceleration * limits.acceleration) return 2.0 * std::sqrt(speed / limits.jerk);
  return speed / limits.acceleration + limits.acceleration / limits.jerk;
}

/// The speed that a motion of that distance has in its middle if it is sped up for half of it and then slowed down.
double middle_speed(double distance, const MotionLimits& limits) {
  const double ramp_s = limits.acceleration / limits.jerk;
  const double from_ramps = std::cbrt(distance * distance * limits.jerk / 4.0);
  if (from_ramps * limits.jerk < limits.acceleration * limits.acceleration) return from_ramps;
  return 0.5 * limits.acceleration * (std::sqrt(ramp_s * ramp_s + 4.0 * distance / limits.acceleration) - ramp_s);
}

double one_axis_s(const RotaryAxis& axis, double deg) {
  if (deg == 0.0) return 0.0;
  return rest_to_rest_s(std::abs(deg),
                        {axis.speed_deg_per_s.value, axis.acceleration_deg_per_s2.value, axis.jerk_deg_per_s3.value});
}

}  // namespace

MotionLimits limits_along(const Machine& machine, const geometry::Vec3& by_mm) {
  MotionLimits along;
  const LinearAxis* const axes[] = {&machine.x, &machine.y, &machine.z};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double share = std::abs(by_mm[k]) / by_mm.norm();
    if (!(share > 0.0)) continue;
    along.acceleration = std::min(along.acceleration, axes[k]->acceleration_mm_per_s2.value / share);
    along.jerk = std::min(along.jerk, axes[k]->jerk_mm_per_s3.value / share);
  }
  return along;
}

double rest_to_rest_s(double distance, const MotionLimits& limits) {
  if (distance <= 0.0) return 0.0;
  const double up_s = speeding_up_s(limits.speed, limits);
  // The mean speed while speeding up and slowing down is half of the greatest.
  if (limits.speed * up_s <= distance) return distance / limits.speed + up_s;
  return 2.0 * distance / middle_speed(distance, limits);
}

double rapid_motion_s(const Machine& machine, const geometry::Vec3& by_mm) {
  const double distance_mm = by_mm.norm();
  if (distance_mm == 0.0) return 0.0;
  MotionLimits line = limits_along(machine, by_mm);
  const LinearAxis* const axes[] = {&machine.x, &machine.y, &machine.z};
  double slowest_s = 0.0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double axis_mm = std::abs(by_mm[k]);
    if (axis_mm == 0.0) continue;
    const double speed = axes[k]->rapid_mm_per_min.value / 60.0;
    line.speed = std::min(line.speed, speed * distance_mm / axis_mm);
    slowest_s = std::max(slowest_s, rest_to_rest_s(axis_mm, {speed, axes[k]->acceleration_mm_per_s2.value,
                                                             axes[k]->jerk_mm_per_s3.value}));
  }
  return machine.control.rapids_are_straight ? rest_to_rest_s(distance_mm, line) : slowest_s;
}

double fed_rotary_motion_s(const Machine& machine, double tilt_deg, double c_deg, double deg_per_min) {
  const double distance_deg = std::hypot(tilt_deg, c_deg);
  MotionLimits path;
  path.speed = deg_per_min / 60.0;
  for (const auto& [axis, by_deg] : {std::pair{&machine.a, tilt_deg}, {&machine.c, c_deg}}) {
    if (by_deg == 0.0) continue;
    const double share = std::abs(by_deg) / distance_deg;
    path.acceleration = std::min(path.acceleration, axis->acceleration_deg_per_s2.value / share);
    path.jerk = std::min(path.jerk, axis->jerk_deg_per_s3.value / share);
  }
  return rest_to_rest_s(distance_deg, path);
}

double rotary_motion_s(const Machine& machine, double tilt_deg, double c_deg) {
  return std::max(one_axis_s(machine.a, tilt_deg), one_axis_s(machine.c, c_deg));
}

}  // namespace retrace::fabrication
