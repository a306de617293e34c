#pragma once

// Limits on quantities, for optimisation and tolerance studies.

#include <optional>
#include <string>

namespace retrace::studies {

/// A limit on a quantity of a study.
struct Constraint {
  std::string quantity;
  std::optional<double> least;
  std::optional<double> most;

  /// By how much a value breaks it; 0 if it holds. What has no value breaks it by infinity.
  double violation(const std::optional<double>& value) const;
  /// "lens_thickness_mm <= 5"
  std::string text() const;
};

}  // namespace retrace::studies
