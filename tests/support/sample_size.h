#pragma once

#include <cmath>
#include <cstdlib>
#include <string_view>

namespace retrace::test {

/// Returns true if statistical tests use their full sample size. `tools/test --long` sets `RETRACE_LONG_TESTS` to 1.
inline bool is_long_run() {
  const char* const value = std::getenv("RETRACE_LONG_TESTS");
  return value != nullptr && std::string_view(value) == "1";
}

/// Returns the sample size of a statistical test: `full` in a long run, otherwise `usual`.
template <class Number>
Number sample_size(Number usual, Number full) {
  return is_long_run() ? full : usual;
}

/// Returns the minimum fraction of 95 % confidence intervals that must contain the true value. The difference from 95 %
/// is a fixed number of standard errors. The standard error is proportional to 1 / sqrt(number of intervals).
/// \param at_full_size minimum fraction for `full_count` intervals
/// \param count number of intervals
inline double min_coverage(double at_full_size, double full_count, double count) {
  return 0.95 - (0.95 - at_full_size) * std::sqrt(full_count / count);
}

}  // namespace retrace::test
