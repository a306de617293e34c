#pragma once

// Function that a search maximizes. Its values may contain random errors with known standard errors.

#include <compare>
#include <cstddef>
#include <optional>
#include <vector>

#include "studies/quantity/error_level.h"

namespace retrace::studies {

/// Point of a search: a combination of discrete values, and the positions of all continuous parameters.
struct SearchPoint {
  std::size_t combination = 0;    ///< index of the combination of discrete values
  std::vector<double> fractions;  ///< positions of the continuous parameters in their intervals, from 0 to 1

  auto operator<=>(const SearchPoint&) const = default;
};

/// Value with its standard error.
struct Estimate {
  double value = 0.0;
  double std_error = 0.0;
};

/// Observed values of a point.
struct Observation {
  std::optional<Estimate> objective;  ///< empty if the objective has no value at this point
  /// Amount by which each limit is exceeded. A limit is satisfied if this amount is at most 0. The amount is infinite
  /// if the limited quantity has no value.
  std::vector<Estimate> excess;
};

/// Function that a search maximizes under constraints. Each constraint limits a quantity.
class SearchedFunction {
 public:
  SearchedFunction() = default;
  virtual ~SearchedFunction() = default;
  SearchedFunction(const SearchedFunction&) = delete;
  SearchedFunction& operator=(const SearchedFunction&) = delete;

  /// Observes points at a level of accuracy. Returns the results in the order of the points.
  virtual std::vector<Observation> observe(const std::vector<SearchPoint>& points, const ErrorLevel& level) = 0;
  /// Returns true if a point satisfies all limits that can be checked without an observation.
  virtual bool is_allowed(const SearchPoint& point) const {
    static_cast<void>(point);
    return true;
  }
  /// Returns points near `point` at which the objective may have a peak. An example are sizes for which a whole number
  /// of elements fills the part.
  /// \param within maximum change of each position
  virtual std::vector<SearchPoint> peaks_near(const SearchPoint& point, double within) const {
    static_cast<void>(point);
    static_cast<void>(within);
    return {};
  }
  /// Returns points near `point` whose values have fewer digits. The point with the fewest digits comes first.
  /// \param within maximum change of each position
  virtual std::vector<SearchPoint> rounder_points(const SearchPoint& point, double within) const {
    static_cast<void>(point);
    static_cast<void>(within);
    return {};
  }
};

}  // namespace retrace::studies
