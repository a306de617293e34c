#include "fabrication/machine/motion_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrace::fabrication {
namespace {

/// Returns the time from rest to a speed. At low speeds, the acceleration rises and falls without reaching its limit.
/// Otherwise, the rise and the fall of the acceleration each take the time acceleration / jerk.
double speeding_up_s(double speed, const MotionLimits& limits) {
  if (speed * limits.jerk < limits.acceleration * limits.acceleration) return 2.0 * std::sqrt(speed / limits.jerk);
  return speed / limits.acceleration + limits.acceleration / limits.jerk;
}

/// Returns the maximum speed of a motion that accelerates over the first half of a distance and decelerates over the
/// second half.
double middle_speed(double distance, const MotionLimits& limits) {
  const double ramp_s = limits.acceleration / limits.jerk;
  const double from_ramps = std::cbrt(distance * distance * limits.jerk / 4.0);
  if (from_ramps * limits.jerk < limits.acceleration * limits.acceleration) return from_ramps;
  return 0.5 * limits.acceleration * (std::sqrt(ramp_s * ramp_s + 4.0 * distance / limits.acceleration) - ramp_s);
}

/// Travel and limits of one axis in a move.
struct AxisMotion {
  double travel = 0.0;  ///< absolute travel, in mm or degrees
  MotionLimits limits;
};

/// Returns travel and limits of X, Y, Z, the tilting axis and C in a move.
/// \param rate maximum speed of the linear axes, in mm/min
std::array<AxisMotion, 5> axis_motions(const Machine& machine, const AxisTravel& by,
                                       Sourced<double> LinearAxis::*rate) {
  constexpr double kSecondsPerMinute = 60.0;
  std::array<AxisMotion, 5> motions;
  const LinearAxis* const linear[] = {&machine.x, &machine.y, &machine.z};
  for (std::size_t k = 0; k < 3; ++k) {
    const LinearAxis& axis = *linear[k];
    motions[k] = {
        std::abs(by.linear_mm[static_cast<Eigen::Index>(k)]),
        {(axis.*rate).value / kSecondsPerMinute, axis.acceleration_mm_per_s2.value, axis.jerk_mm_per_s3.value}};
  }
  const auto rotary = [](const RotaryAxis& axis, double by_deg) -> AxisMotion {
    return {std::abs(by_deg),
            {axis.speed_deg_per_s.value, axis.acceleration_deg_per_s2.value, axis.jerk_deg_per_s3.value}};
  };
  motions[3] = rotary(machine.a, by.tilt_deg);
  motions[4] = rotary(machine.c, by.c_deg);
  return motions;
}

/// Returns the limits along the path of a move in which all axes start and end together.
MotionLimits limits_along(const std::array<AxisMotion, 5>& motions, double length) {
  MotionLimits along;
  for (const auto& [travel, limits] : motions) {
    const double share = travel / length;
    if (!(share > 0.0)) continue;
    along.speed = std::min(along.speed, limits.speed / share);
    along.acceleration = std::min(along.acceleration, limits.acceleration / share);
    along.jerk = std::min(along.jerk, limits.jerk / share);
  }
  return along;
}

}  // namespace

double AxisTravel::length() const {
  const double length_mm = linear_mm.norm();
  return length_mm > 0.0 ? length_mm : std::hypot(tilt_deg, c_deg);
}

double rest_to_rest_s(double distance, const MotionLimits& limits) {
  if (distance <= 0.0) return 0.0;
  const double up_s = speeding_up_s(limits.speed, limits);
  // During acceleration and deceleration, the mean speed is half of the maximum speed.
  if (limits.speed * up_s <= distance) return distance / limits.speed + up_s;
  return 2.0 * distance / middle_speed(distance, limits);
}

double rapid_motion_s(const Machine& machine, const AxisTravel& by) {
  const std::array<AxisMotion, 5> motions = axis_motions(machine, by, &LinearAxis::rapid_mm_per_min);
  if (machine.control.rapids_are_straight) return rest_to_rest_s(by.length(), limits_along(motions, by.length()));
  double slowest_s = 0.0;
  for (const auto& [travel, limits] : motions) slowest_s = std::max(slowest_s, rest_to_rest_s(travel, limits));
  return slowest_s;
}

double fed_motion_s(const Machine& machine, const AxisTravel& by, double feed_per_min) {
  const double length = by.length();
  MotionLimits path = limits_along(axis_motions(machine, by, &LinearAxis::max_feed_mm_per_min), length);
  path.speed = std::min(path.speed, feed_per_min / 60.0);
  return rest_to_rest_s(length, path);
}

}  // namespace retrace::fabrication
