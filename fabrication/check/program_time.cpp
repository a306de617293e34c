#include "fabrication/check/program_time.h"

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
  // The first rotary move is assumed to start at A = C = 0, because the tool is touched off in this position.
  const RotaryPose from = rotary_pose(machine, motion.from);
  const RotaryPose to = rotary_pose(machine, motion.to);
  const AxisTravel by{travel, to.a_deg - from.a_deg, to.c_deg - from.c_deg};
  const bool is_rotary = travel.norm() == 0.0;
  const bool is_fed = motion.move == NcMove::linear && motion.feed_mm_per_min > 0.0;
  const double moving_s = is_fed ? fed_motion_s(machine, by, motion.feed_mm_per_min) : rapid_motion_s(machine, by);
  if (moving_s == 0.0) return;
  const bool is_turn =
      rapid_motion_s(machine, {geometry::Vec3::Zero(), by.tilt_deg, by.c_deg}) > rapid_motion_s(machine, {travel});
  const bool settles = !is_fed || is_rotary || motion.is_exact_stop;
  double& spent_s = is_fed ? feed_s : is_turn ? rotary_s : rapid_s;
  spent_s += moving_s + (settles ? machine.settling_s.value : 0.0);
}

}  // namespace retrace::fabrication
