#pragma once

// Constraints on quantities, for optimizations and tolerance studies.

#include <optional>
#include <string>

namespace retrace::studies {

/// Constraint on a quantity of a study.
struct Constraint {
  std::string quantity;
  std::optional<double> min;
  std::optional<double> max;

  /// Returns by how much a value violates the constraint; 0 if it is satisfied. A missing value violates it infinitely.
  double violation(const std::optional<double>& value) const;
  /// Returns a text such as "lens_thickness_mm <= 5".
  std::string text() const;
};

}  // namespace retrace::studies
