#pragma once

// Form error of a facet: a polynomial that describes the deviation of its surface from a plane, such as sink marks of a
// moulded part.

#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace retrace::surface_models {

/// Height above a facet's plane, positive out of the body: the sum of c_ij x^i y^j with i + j <= kMaxDegree. x is
/// horizontal and y points down the facet. The origin is above the centroid of the facet. Lengths are in mm.
class FacetForm {
 public:
  static constexpr int kMaxDegree = 8;

  /// Adds a term.
  /// \param coefficient in mm^(1 - i - j)
  /// \pre i, j >= 0, i + j <= kMaxDegree
  void add(int i, int j, double coefficient);
  void add(const FacetForm& other);

  /// Returns true if there are no terms.
  bool is_plane() const { return coefficients_.empty(); }
  double height_mm(const geometry::Vec2& p) const;
  geometry::Vec2 slope(const geometry::Vec2& p) const;

 private:
  static constexpr std::size_t kSide = kMaxDegree + 1;

  std::vector<double> coefficients_;  ///< coefficient of x^i y^j at index kSide i + j; empty if all are 0
  int degree_ = 0;
};

}  // namespace retrace::surface_models
