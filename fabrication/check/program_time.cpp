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
  // The tool is touched off at A = C = 0, from where the first turn starts.
  const RotaryPose from = rotary_pose(machine, motion.from);
  const RotaryPose to = rotary_pose(machine, motion.to);
  const double tilt_deg = to.a_deg - from.a_deg;
  const double c_deg = to.c_deg - from.c_deg;
  const bool is_fed = motion.move == NcMove::linear && motion.feed_mm_per_min > 0.0;
  const bool turns = tilt_deg != 0.0 || c_deg != 0.0;
  double linear_s = 0.0;
  if (motion.move == NcMove::rapid) {
    linear_s = rapid_motion_s(machine, travel);
  } else if (is_fed && distance > 0.0) {
    MotionLimits path = limits_along(machine, travel);
    path.speed = motion.feed_mm_per_min / 60.0;
    linear_s = rest_to_rest_s(distance, path);
  }
  // Rotary and linear axes of one move arrive together. If only rotary axes move, the feed is in degrees per minute.
  const bool is_turn_fed = is_fed && distance == 0.0 && turns;
  const double turning_s = is_turn_fed ? fed_rotary_motion_s(machine, tilt_deg, c_deg, motion.feed_mm_per_min)
                                       : rotary_motion_s(machine, tilt_deg, c_deg);
  const double moving_s = std::max(linear_s, turning_s);
  if (moving_s == 0.0) return;
  const bool settles = motion.move == NcMove::rapid || distance == 0.0 || motion.is_exact_stop;
  double& spent_s = turning_s > linear_s ? (is_turn_fed ? feed_s : rotary_s) : is_fed ? feed_s : rapid_s;
  spent_s += moving_s + (settles ? machine.settling_s.value : 0.0);
}

}  // namespace retrace::fabrication
