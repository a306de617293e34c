#pragma once

// Function that a search maximizes. Its values may have random errors, whose standard errors are known.

#include <compare>
#include <cstddef>
#include <optional>
#include <vector>

#include "studies/quantity/error_level.h"

namespace retrace::studies {

/// Point of a search: a combination of discrete values, and the position of each continuous parameter in its interval.
struct SearchPoint {
  std::size_t combination = 0;  ///< index of the combination of discrete values
  /// position of each continuous parameter in its interval: 0 at the start, 1 at the end
  std::vector<double> fractions;

  auto operator<=>(const SearchPoint&) const = default;
};

/// Estimated value and its standard error.
struct Estimate {
  double value = 0.0;
  double std_error = 0.0;
};

/// Values that are observed at a point.
struct Observation {
  std::optional<Estimate> objective;  ///< empty if the objective is not defined at this point
  /// Excess over each limit: the amount by which the limit is exceeded, or a negative margin if the limit is satisfied.
  /// It is infinite if the limited quantity has no value.
  std::vector<Estimate> excess;
};

/// Function that a search maximizes. Other quantities may be constrained by limits.
class SearchedFunction {
 public:
  SearchedFunction() = default;
  virtual ~SearchedFunction() = default;
  SearchedFunction(const SearchedFunction&) = delete;
  SearchedFunction& operator=(const SearchedFunction&) = delete;

  /// Observes points at a level of accuracy. Returns one observation for each point, in the same order.
  virtual std::vector<Observation> observe(const std::vector<SearchPoint>& points, const ErrorLevel& level) = 0;
  /// Returns true if a point satisfies all limits that can be checked without observing it.
  virtual bool is_allowed(const SearchPoint& point) const {
    static_cast<void>(point);
    return true;
  }
  /// Returns points near `point` at which the objective may have a peak. Such peaks occur at sizes with which a whole
  /// number of elements fills the part.
  /// \param within maximum change of each continuous parameter, as a fraction of its interval
  virtual std::vector<SearchPoint> peaks_near(const SearchPoint& point, double within) const {
    static_cast<void>(point);
    static_cast<void>(within);
    return {};
  }
  /// Returns points near `point` whose parameters have fewer digits. The point with the fewest digits comes first.
  /// \param within maximum change of each continuous parameter, as a fraction of its interval
  virtual std::vector<SearchPoint> rounder_points(const SearchPoint& point, double within) const {
    static_cast<void>(point);
    static_cast<void>(within);
    return {};
  }
};

}  // namespace retrace::studies
