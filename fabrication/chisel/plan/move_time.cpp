#include "fabrication/chisel/plan/move_time.h"

#include "fabrication/machine/motion_time.h"

namespace retrace::fabrication {

double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min) {
  const AxisTravel by{by_mm};
  const double seconds = feed_mm_per_min ? fed_motion_s(machine, by, *feed_mm_per_min) : rapid_motion_s(machine, by);
  return seconds > 0.0 ? seconds + machine.settling_s.value : 0.0;
}

double rotary_move_s(const Machine& machine, double a_deg, double c_deg) {
  const double seconds = rapid_motion_s(machine, {geometry::Vec3::Zero(), a_deg, c_deg});
  return seconds > 0.0 ? seconds + machine.settling_s.value : 0.0;
}

}  // namespace retrace::fabrication
