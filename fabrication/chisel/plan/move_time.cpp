#include "fabrication/chisel/plan/move_time.h"

#include <algorithm>
#include <cmath>

#include "fabrication/machine/motion_time.h"

namespace retrace::fabrication {

double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min) {
  const double distance_mm = by_mm.norm();
  if (distance_mm <= 0.0) return 0.0;
  if (!feed_mm_per_min) return rapid_motion_s(machine, by_mm) + machine.settling_s.value;
  constexpr double kSecondsPerMinute = 60.0;
  MotionLimits path = limits_along(machine, by_mm);
  path.speed = *feed_mm_per_min / kSecondsPerMinute;
  const LinearAxis* const axes[] = {&machine.x, &machine.y, &machine.z};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double share = std::abs(by_mm[k]) / distance_mm;
    if (share <= 0.0) continue;
    path.speed = std::min(path.speed, axes[k]->max_feed_mm_per_min.value / kSecondsPerMinute / share);
  }
  return rest_to_rest_s(distance_mm, path) + machine.settling_s.value;
}

double rotary_move_s(const Machine& machine, double a_deg, double c_deg) {
  const double seconds = rotary_motion_s(machine, a_deg, c_deg);
  return seconds > 0.0 ? seconds + machine.settling_s.value : 0.0;
}

}  // namespace retrace::fabrication
