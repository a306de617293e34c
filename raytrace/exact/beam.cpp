#include "raytrace/exact/beam.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrace::raytrace {
namespace {

/// Returns the mean of exp(-x) for a <= x <= b.
/// \pre a <= b
double mean_exp(double a, double b) {
  const double width = b - a;
  return width > 0.0 ? std::exp(-a) * -std::expm1(-width) / width : std::exp(-a);
}

// Maximum change of x over a triangle for which mean_exp() uses its series. For such changes, the first kTerms terms of
// the series give a result that is exact except for rounding.
constexpr double kNarrow = 0.5;
constexpr std::size_t kTerms = 14;

/// Returns the coefficients (-1)^k 2 / (k + 2)! of the series in mean_exp(a, b, c), for k = 0 to kTerms - 1.
constexpr std::array<double, kTerms> series_of_triangle() {
  std::array<double, kTerms> factors{1.0};
  for (std::size_t k = 1; k < kTerms; ++k) factors[k] = -factors[k - 1] / (static_cast<double>(k) + 2.0);
  return factors;
}

/// Returns the mean of exp(-x) over a triangle. x is linear on the triangle and has the values a, b and c at its
/// corners. The mean is twice the divided difference of exp(-x) at a, b and c (Hermite-Genocchi formula).
/// If x changes by more than kNarrow, the recursion of divided differences is used, because it then has little
/// cancellation. Otherwise, a series in h_k(u, v) = u h_(k-1) + v^k is used, with u = b - a and v = c - a. The h_k are
/// the complete homogeneous symmetric polynomials.
double mean_exp(double a, double b, double c) {
  const double u = b - a;
  const double v = c - a;
  if (std::max(std::abs(u), std::abs(v)) > kNarrow) {
    std::array<double, 3> at = {a, b, c};
    std::sort(at.begin(), at.end());
    return 2.0 * (mean_exp(at[0], at[1]) - mean_exp(at[1], at[2])) / (at[2] - at[0]);
  }
  constexpr std::array<double, kTerms> kFactors = series_of_triangle();
  double h = 1.0;
  double power = 1.0;
  double sum = 1.0;
  for (std::size_t k = 1; k < kTerms; ++k) {
    power *= v;
    h = u * h + power;
    sum += kFactors[k] * h;
  }
  return std::exp(-a) * sum;
}

}  // namespace

Beam moved(Beam beam, const Vec2& by_mm, const Vec3& to_source, double index) {
  const Vec3 by(by_mm.x(), by_mm.y(), 0.0);
  for (Vec3& corner : beam.corners) corner += by;
  beam.phase_mm -= (index * beam.direction + to_source).dot(by);
  beam.path_length.constant_mm -= beam.path_length.slope.dot(by);
  beam.entry.constant_mm += by_mm - beam.entry.slope * by;
  for (TexturedHit& hit : beam.hits) {
    hit.plane.offset_mm += hit.plane.normal.dot(by);
    hit.constant_mm += by - hit.slope * by;
    hit.frame.origin_mm += by;
  }
  if (beam.trail.first) beam.trail.first->offset_mm += by_mm;
  beam.start.offset_mm += beam.start.normal.dot(by);
  beam.instance_offsets = nullptr;
  return beam;
}

FlatPolygon flattened(const Corners& corners, const Frame& frame, double merge_mm) {
  FlatPolygon polygon;
  for (const Vec3& p : corners) add_corner(polygon, frame.across(p), merge_mm);
  close(polygon, merge_mm);
  if (area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  make_convex(polygon);
  return polygon;
}

Corners lifted(const FlatPolygon& polygon, const Frame& frame, const Distance& distance) {
  Corners corners;
  for (const Vec2& p : polygon) corners.push_back(p.x() * frame.u + p.y() * frame.v + distance.at(p) * frame.w);
  return corners;
}

Corners cut(const Corners& corners, const Plane& plane) {
  Corners kept;
  const std::size_t n = corners.size();
  double before = n > 0 ? plane.height(corners[n - 1]) : 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = corners[i];
    const double here = plane.height(p);
    if ((before < 0.0 && here > 0.0) || (before > 0.0 && here < 0.0)) {
      const Vec3& q = corners[i == 0 ? n - 1 : i - 1];
      kept.push_back(q + (p - q) * (before / (before - here)));
    }
    if (here >= 0.0) kept.push_back(p);
    before = here;
  }
  if (kept.size() < 3) kept.clear();
  return kept;
}

Corners cut_to_outline(Corners corners, const geometry::Polygon& outline) {
  for (std::size_t k = 0; k < outline.size() && !corners.empty(); ++k) {
    const Vec2 along = (outline[(k + 1) % outline.size()] - outline[k]).normalized();
    const Vec3 inward(-along.y(), along.x(), 0.0);
    corners = cut(corners, {inward, inward.head<2>().dot(outline[k])});
  }
  return corners;
}

double mean_transmission(const Corners& corners, const PathLength& path_length, double absorption_per_mm) {
  if (absorption_per_mm <= 0.0) return 1.0;
  const auto depth = [&](std::size_t k) { return absorption_per_mm * path_length.at(corners[k]); };
  double sum = 0.0;
  double whole = 0.0;
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const double weight = (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]).norm();
    sum += weight * mean_exp(depth(0), depth(k - 1), depth(k));
    whole += weight;
  }
  return whole > 0.0 ? sum / whole : std::exp(-depth(0));
}

}  // namespace retrace::raytrace
