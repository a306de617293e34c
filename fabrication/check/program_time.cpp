#include "fabrication/check/program_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace retrace::fabrication {
namespace {

/// Time of a move that starts and ends at rest.
double trapezoid_s(double distance, double speed_per_s, double acceleration_per_s2) {
  if (!(distance > 0.0)) return 0.0;
  if (distance >= speed_per_s * speed_per_s / acceleration_per_s2)
    return distance / speed_per_s + speed_per_s / acceleration_per_s2;
  return 2.0 * std::sqrt(distance / acceleration_per_s2);
}

}  // namespace

void ProgramTime::add(const Machine& machine, const NcMotion& motion) {
  const auto known = [&](unsigned bit) { return (motion.known >> bit & 1U) != 0; };
  const std::array<double, 3> travel = {known(0) ? motion.to.x_mm - motion.from.x_mm : 0.0,
                                        known(1) ? motion.to.y_mm - motion.from.y_mm : 0.0,
                                        known(2) ? motion.to.z_mm - motion.from.z_mm : 0.0};
  const std::array<const LinearAxis*, 3> axes = {&machine.x, &machine.y, &machine.z};
  const double distance = std::hypot(travel[0], travel[1], travel[2]);
  if (motion.move == NcMove::linear && distance > 0.0 && motion.feed_mm_per_min > 0.0) {
    double acceleration = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i)
      if (travel[i] != 0.0)
        acceleration = std::min(acceleration, axes[i]->acceleration_mm_per_s2.value * distance / std::abs(travel[i]));
    feed_s += trapezoid_s(distance, motion.feed_mm_per_min / 60.0, acceleration);
  }
  if (motion.move == NcMove::rapid && distance > 0.0) {
    double slowest_s = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      slowest_s = std::max(slowest_s, trapezoid_s(std::abs(travel[i]), axes[i]->rapid_mm_per_min.value / 60.0,
                                                  axes[i]->acceleration_mm_per_s2.value));
    rapid_s += slowest_s;
  }
  // The tool is touched off at A = C = 0, from where the first turn starts.
  const RotaryPose from = rotary_pose(machine, motion.from);
  const RotaryPose to = rotary_pose(machine, motion.to);
  const double a_s = trapezoid_s(std::abs(to.a_deg - from.a_deg), machine.a.speed_deg_per_s.value,
                                 machine.a.acceleration_deg_per_s2.value);
  const double c_s = trapezoid_s(std::abs(to.c_deg - from.c_deg), machine.c.speed_deg_per_s.value,
                                 machine.c.acceleration_deg_per_s2.value);
  rotary_s += std::max(a_s, c_s);
}

}  // namespace retrace::fabrication
