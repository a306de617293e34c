#include "fabrication/check/program_time.h"

#include <algorithm>
#include <cmath>

#include "fabrication/machine/motion_time.h"

namespace retrace::fabrication {

void ProgramTime::add(const Machine& machine, const NcMotion& motion) {
  if (motion.duration_s > 0.0) {
    feed_s += motion.duration_s;
    return;
  }
  const auto known = [&](unsigned bit) { return (motion.known >> bit & 1U) != 0; };
  const geometry::Vec3 travel(known(0) ? motion.to.x_mm - motion.from.x_mm : 0.0,
                              known(1) ? motion.to.y_mm - motion.from.y_mm : 0.0,
                              known(2) ? motion.to.z_mm - motion.from.z_mm : 0.0);
  const double distance = travel.norm();
  if (motion.move == NcMove::linear && distance > 0.0 && motion.feed_mm_per_min > 0.0) {
    MotionLimits path = limits_along(machine, travel);
    path.speed = motion.feed_mm_per_min / 60.0;
    feed_s += rest_to_rest_s(distance, path) + (motion.is_exact_stop ? machine.settling_s.value : 0.0);
  }
  if (motion.move == NcMove::rapid && distance > 0.0) {
    const LinearAxis* const axes[] = {&machine.x, &machine.y, &machine.z};
    double slowest_s = 0.0;
    for (Eigen::Index i = 0; i < 3; ++i)
      slowest_s = std::max(slowest_s, rest_to_rest_s(std::abs(travel[i]), {axes[i]->rapid_mm_per_min.value / 60.0,
                                                                           axes[i]->acceleration_mm_per_s2.value,
                                                                           axes[i]->jerk_mm_per_s3.value}));
    rapid_s += slowest_s + machine.settling_s.value;
  }
  // The tool is touched off at A = C = 0, from where the first turn starts.
  const RotaryPose from = rotary_pose(machine, motion.from);
  const RotaryPose to = rotary_pose(machine, motion.to);
  const double turning_s = rotary_motion_s(machine, to.a_deg - from.a_deg, to.c_deg - from.c_deg);
  if (turning_s > 0.0) rotary_s += turning_s + (distance > 0.0 ? 0.0 : machine.settling_s.value);
}

}  // namespace retrace::fabrication
