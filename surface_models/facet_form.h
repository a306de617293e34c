#pragma once

// The form of a facet: a polynomial by which its surface departs from its plane, such as sink of a moulded part.

#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace retrace::surface_models {

/// Heights over a facet's plane, out of the body: the sum of c_ij x^i y^j, i + j <= kMostDegree, with x level and y
/// down the facet from its middle. All lengths in mm.
class FacetForm {
 public:
  static constexpr int kMostDegree = 8;

  /// Adds a term. \param coefficient in mm^(1 - i - j) \pre i, j >= 0, i + j <= kMostDegree
  void add(int i, int j, double coefficient);
  void add(const FacetForm& other);

  /// Whether it is the plane itself.
  bool is_plane() const { return coefficients_.empty(); }
  double height_mm(const geometry::Vec2& p) const;
  geometry::Vec2 slope(const geometry::Vec2& p) const;

 private:
  static constexpr std::size_t kSide = kMostDegree + 1;

  std::vector<double> coefficients_;  ///< that of x^i y^j at kSide i + j; empty: all are 0
  int degree_ = 0;
};

}  // namespace retrace::surface_models
