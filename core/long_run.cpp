#include "core/long_run.h"

#include <fmt/format.h>

namespace retrace {

std::optional<double> LongRun::remaining_s(double fraction, double elapsed_s) {
  if (!first_fraction_) first_fraction_ = fraction;
  if (!(fraction > *first_fraction_)) return std::nullopt;
  return (elapsed_s - begun_s_) * (1.0 - fraction) / (fraction - *first_fraction_);
}

std::optional<double> LongRun::notice_s(double fraction, double elapsed_s) {
  const std::optional<double> remaining = remaining_s(fraction, elapsed_s);
  const bool is_long = remaining && elapsed_s - begun_s_ >= kFirstEstimateS && *remaining > kLongS;
  if (is_user_informed_ || !is_long) return std::nullopt;
  is_user_informed_ = true;
  return remaining;
}

void LongRun::begin_part(double fraction, double elapsed_s) {
  first_fraction_ = fraction;
  begun_s_ = elapsed_s;
}

std::string duration_text(double seconds) {
  constexpr double minute_s = 60.0;
  constexpr double hour_s = 3600.0;
  constexpr double day_s = 86400.0;
  if (seconds < 2.0 * minute_s) return fmt::format("{:.0f} s", seconds);
  if (seconds < 1.5 * hour_s) return fmt::format("{:.0f} min", seconds / minute_s);
  if (seconds < 2.0 * day_s) return fmt::format("{:.1f} h", seconds / hour_s);
  return fmt::format("{:.1f} days", seconds / day_s);
}

}  // namespace retrace
