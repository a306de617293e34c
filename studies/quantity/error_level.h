#pragma once

// Accuracy of a computation that uses random numbers.

#include <compare>
#include <cstdint>

namespace retrace::studies {

/// Accuracy of a computation, and the stream of its random numbers.
struct ErrorLevel {
  double scale = 1.0;  ///< target error of the computation, as a multiple of the target error of the study
  /// Number of the stream of random numbers. Computations with the same number use common random numbers. Their errors
  /// are correlated, and differences of their results are more accurate.
  std::uint32_t replicate = 0;

  bool operator==(const ErrorLevel&) const = default;
  auto operator<=>(const ErrorLevel&) const = default;
};

}  // namespace retrace::studies
