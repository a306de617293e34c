#include "surface_models/facet_form.h"

#include <algorithm>

namespace retrace::surface_models {

using geometry::Vec2;

void FacetForm::add(int i, int j, double coefficient) {
  if (coefficient == 0.0) return;
  coefficients_.resize(kSide * kSide, 0.0);
  coefficients_[kSide * static_cast<std::size_t>(i) + static_cast<std::size_t>(j)] += coefficient;
  degree_ = std::max(degree_, i + j);
}

void FacetForm::add(const FacetForm& other) {
  for (int i = 0; !other.is_plane() && i <= other.degree_; ++i)
    for (int j = 0; i + j <= other.degree_; ++j)
      add(i, j, other.coefficients_[kSide * static_cast<std::size_t>(i) + static_cast<std::size_t>(j)]);
}

double FacetForm::height_mm(const Vec2& p) const {
  if (is_plane()) return 0.0;
  double height = 0.0;
  for (int i = degree_; i >= 0; --i) {
    double of_y = 0.0;
    for (int j = degree_ - i; j >= 0; --j)
      of_y = of_y * p.y() + coefficients_[kSide * static_cast<std::size_t>(i) + static_cast<std::size_t>(j)];
    height = height * p.x() + of_y;
  }
  return height;
}

Vec2 FacetForm::slope(const Vec2& p) const {
  Vec2 slope = Vec2::Zero();
  if (is_plane()) return slope;
  for (int i = degree_; i >= 0; --i) {
    double of_y = 0.0;
    double along_y = 0.0;
    for (int j = degree_ - i; j >= 0; --j) {
      const double c = coefficients_[kSide * static_cast<std::size_t>(i) + static_cast<std::size_t>(j)];
      if (j > 0) along_y = along_y * p.y() + j * c;
      of_y = of_y * p.y() + c;
    }
    if (i > 0) slope.x() = slope.x() * p.x() + i * of_y;
    slope.y() = slope.y() * p.x() + along_y;
  }
  return slope;
}

}  // namespace retrace::surface_models
