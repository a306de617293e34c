#include "fabrication/machine/motion_time.h"

#include <algorithm>
#include <cmath>

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

double rotary_motion_s(const Machine& machine, double tilt_deg, double c_deg) {
  return std::max(one_axis_s(machine.a, tilt_deg), one_axis_s(machine.c, c_deg));
}

}  // namespace retrace::fabrication
