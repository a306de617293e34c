#include "raytrace/observers/polygon_transform.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using geometry::Vec2;
using Complex = std::complex<double>;

// If the phase varies by less than this value over a polygon, its transform is the area times the phase factor at the
// centroid. The relative error is the square of this value.
constexpr double kFlat = 1e-5;
// If the phase varies by less than this value along an edge, a series is used, because differences would cancel.
constexpr double kShort = 0.05;

Complex unit(double phase) {
  return {std::cos(phase), std::sin(phase)};
}

/// Returns the mean of exp(-i x) over an edge, from the phase at one end to the phase at the other end.
Complex mean_along(double phase_from, const Complex& from, double phase_to, const Complex& to) {
  const double step = phase_to - phase_from;
  if (std::abs(step) > kShort) return (to - from) / Complex(0.0, -step);
  const double square = step * step;
  return unit(-0.5 * (phase_from + phase_to)) * (1.0 - square / 24.0 * (1.0 - square / 80.0));
}

}  // namespace

PolygonTransform::PolygonTransform(const geometry::Polygon& polygon)
    : corners_(polygon), centroid_mm_(geometry::centroid(polygon)), area_mm2_(geometry::area(polygon)) {
  for (const Vec2& corner : corners_) size_mm_ = std::max(size_mm_, (corner - centroid_mm_).norm());
}

Complex PolygonTransform::at(const Vec2& kappa) const {
  const double square = kappa.squaredNorm();
  const double middle = kappa.dot(centroid_mm_);
  if (std::sqrt(square) * size_mm_ < kFlat) return area_mm2_ * unit(-middle);
  Complex sum = 0.0;
  // Phases are relative to the centroid, so that they are accurate at any position of the polygon.
  Vec2 from = corners_.back() - centroid_mm_;
  double phase_from = kappa.dot(from);
  Complex wave_from = unit(-phase_from);
  for (const Vec2& corner : corners_) {
    const Vec2 to = corner - centroid_mm_;
    const double phase_to = kappa.dot(to);
    const Complex wave_to = unit(-phase_to);
    const Vec2 edge = to - from;
    sum += (kappa.x() * edge.y() - kappa.y() * edge.x()) * mean_along(phase_from, wave_from, phase_to, wave_to);
    from = to;
    phase_from = phase_to;
    wave_from = wave_to;
  }
  return Complex(0.0, 1.0 / square) * sum * unit(-middle);
}

}  // namespace retrace::raytrace
