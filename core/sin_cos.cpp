#include "core/sin_cos.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace retrace {
namespace {

constexpr double kStep_deg = 15.0;
constexpr std::int64_t kStepsOfTurn = 24;
constexpr std::int64_t kStepsOfQuarter = 6;
// Maximum relative deviation |angle - m| / |angle| from the nearest multiple m of 15 degrees at which an angle is
// regarded as equal to m. The rounding errors of a conversion to radians and back are smaller.
constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();

// Sines of 0, 15, ... 90 degrees. The sine of 15 degrees is (sqrt(6) - sqrt(2)) / 4, and the sine of 75 degrees is
// (sqrt(6) + sqrt(2)) / 4.
constexpr std::array<double, kStepsOfQuarter + 1> kSines = {
    0.0, 0.25881904510252076235, 0.5, 0.5 * std::numbers::sqrt2, 0.5 * std::numbers::sqrt3, 0.96592582628906828675,
    1.0};

/// Returns the sine of `step` times 15 degrees.
/// \param step integer from 0 to 23
double sine_of(std::int64_t step) {
  const std::int64_t half = 2 * kStepsOfQuarter;
  const std::int64_t within = step % half;
  const double sine = kSines[static_cast<std::size_t>(within <= kStepsOfQuarter ? within : half - within)];
  return step <= half ? sine : -sine;
}

}  // namespace

SinCos sin_cos(Angle angle) {
  const double steps = std::remainder(angle.deg(), 360.0) / kStep_deg;
  const double nearest = std::round(steps);
  // The condition is written as !(a <= b) because a <= b is false for infinite angles and NaN. The standard library
  // then handles these angles as well.
  if (!(std::abs(steps - nearest) * kStep_deg <= kRounding * std::abs(angle.deg())))
    return {std::sin(angle.rad()), std::cos(angle.rad())};
  const std::int64_t step = (static_cast<std::int64_t>(nearest) + kStepsOfTurn) % kStepsOfTurn;
  return {sine_of(step), sine_of((step + kStepsOfQuarter) % kStepsOfTurn)};
}

}  // namespace retrace
