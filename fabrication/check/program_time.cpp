#include "fabrication/check/program_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fabrication/machine/motion_time.h"

namespace retrace::fabrication {
void ProgramTime::add(const Machine& machine, const NcMotion& motion) {
  const auto known = [&](unsigned bit) { return (motion.known >> bit & 1U) != 0; };
  const std::array<double, 3> travel = {known(0) ? motion.to.x_mm - motion.from.x_mm : 0.0,
                                        known(1) ? motion.to.y_mm - motion.from.y_mm : 0.0,
                                        known(2) ? motion.to.z_mm - motion.from.z_mm : 0.0};
  const std::array<const LinearAxis*, 3> axes = {&machine.x, &machine.y, &machine.z};
  const double distance = std::hypot(travel[0], travel[1], travel[2]);
  if (motion.move == NcMove::linear && distance > 0.0 && motion.feed_mm_per_min > 0.0) {
    MotionLimits path{motion.feed_mm_per_min / 60.0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 3; ++i) {
      if (travel[i] == 0.0) continue;
      const double along = distance / std::abs(travel[i]);
      path.acceleration = std::min(path.acceleration, axes[i]->acceleration_mm_per_s2.value * along);
      path.jerk = std::min(path.jerk, axes[i]->jerk_mm_per_s3.value * along);
    }
    feed_s += rest_to_rest_s(distance, path) + (motion.is_exact_stop ? machine.settling_s.value : 0.0);
  }
  if (motion.move == NcMove::rapid && distance > 0.0) {
    double slowest_s = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
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
