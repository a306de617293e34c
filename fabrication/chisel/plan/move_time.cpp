#include "fabrication/chisel/plan/move_time.h"

#include <algorithm>
#include <cmath>

namespace retrace::fabrication {

double rest_to_rest_s(double distance, double speed, double acceleration) {
  // Too short to reach the speed: half of it speeding up, half slowing down.
  if (distance * acceleration < speed * speed) return 2.0 * std::sqrt(distance / acceleration);
  return distance / speed + speed / acceleration;
}

double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min) {
  const double distance_mm = by_mm.norm();
  if (distance_mm <= 0.0) return 0.0;
  constexpr double kSecondsPerMinute = 60.0;
  double speed = feed_mm_per_min ? *feed_mm_per_min / kSecondsPerMinute : INFINITY;
  double acceleration = INFINITY;
  const LinearAxis* const axes[] = {&machine.x, &machine.y, &machine.z};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double share = std::abs(by_mm[k]) / distance_mm;
    if (share <= 0.0) continue;
    const LinearAxis& axis = *axes[k];
    const double most = feed_mm_per_min ? axis.max_feed_mm_per_min.value : axis.rapid_mm_per_min.value;
    speed = std::min(speed, most / kSecondsPerMinute / share);
    acceleration = std::min(acceleration, axis.acceleration_mm_per_s2.value / share);
  }
  return rest_to_rest_s(distance_mm, speed, acceleration);
}

double rotary_move_s(const Machine& machine, double a_deg, double c_deg) {
  const auto one = [](const RotaryAxis& axis, double deg) {
    return deg == 0.0 ? 0.0
                      : rest_to_rest_s(std::abs(deg), axis.speed_deg_per_s.value, axis.acceleration_deg_per_s2.value);
  };
  return std::max(one(machine.a, a_deg), one(machine.c, c_deg));
}

}  // namespace retrace::fabrication
