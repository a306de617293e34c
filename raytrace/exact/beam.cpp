#include "raytrace/exact/beam.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrace::raytrace {
namespace {

/// Mean of exp(-x) from a to b. \pre a <= b
double mean_exp(double a, double b) {
  const double width = b - a;
  return width > 0.0 ? std::exp(-a) * -std::expm1(-width) / width : std::exp(-a);
}

/// Mean of exp(-x) over a triangle on which x is linear with the values given at its corners: twice the divided
/// difference of exp(-x) (Hermite-Genocchi). Wide ones by the recursion of divided differences, which cancels little
/// there; narrow ones as a series in complete homogeneous symmetric polynomials of the deviations from the mean.
double mean_exp(double a, double b, double c) {
  constexpr double kWide = 2.0;
  constexpr double kNegligible = 1e-18;
  std::array<double, 3> at = {a, b, c};
  std::sort(at.begin(), at.end());
  if (at[2] - at[0] > kWide) return 2.0 * (mean_exp(at[0], at[1]) - mean_exp(at[1], at[2])) / (at[2] - at[0]);
  const double middle = (a + b + c) / 3.0;
  const double x = a - middle;
  const double y = b - middle;
  const double z = c - middle;
  const double e2 = x * y + y * z + z * x;
  const double e3 = x * y * z;
  double h[3] = {1.0, 0.0, -e2};  // h_k = e1 h_(k-1) - e2 h_(k-2) + e3 h_(k-3), e1 = 0
  double factor = 1.0 / 12.0;     // 2 / (k+2)! at k = 2
  double sum = 1.0 + factor * h[2];
  // h_k has (k + 1)(k + 2) / 2 terms, none above the largest deviation to the power of k.
  const double largest = at[2] - at[0];
  double power = largest * largest;
  for (int k = 3; k < 40; ++k) {
    const double next = -e2 * h[1] + e3 * h[0];
    h[0] = h[1];
    h[1] = h[2];
    h[2] = next;
    factor /= -(k + 2.0);
    power *= largest;
    if (std::abs(factor) * power * (k + 1.0) * (k + 2.0) < kNegligible) break;
    sum += factor * next;
  }
  return std::exp(-middle) * sum;
}

/// Up to this the mean of exp(-x) is a series of kTerms terms about 0, exact to rounding.
constexpr double kNarrow = 0.5;
constexpr std::size_t kTerms = 14;

/// (-1)^k 2 / (k + 2)!
constexpr std::array<double, kTerms> series_of_triangle() {
  std::array<double, kTerms> factors{1.0};
  for (std::size_t k = 1; k < kTerms; ++k) factors[k] = -factors[k - 1] / (static_cast<double>(k) + 2.0);
  return factors;
}

/// Mean of exp(-x) over a triangle on which x is linear, 0 at one corner and a and b at the others, both within
/// +-kNarrow: a series in the complete homogeneous symmetric polynomials h_k(a, b) = a h_(k-1) + b^k.
double mean_exp_narrow(double a, double b) {
  constexpr std::array<double, kTerms> kFactors = series_of_triangle();
  double h = 1.0;
  double power = 1.0;
  double sum = 1.0;
  for (std::size_t k = 1; k < kTerms; ++k) {
    power *= b;
    h = a * h + power;
    sum += kFactors[k] * h;
  }
  return sum;
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
  beam.places = nullptr;
  return beam;
}

FlatPolygon flattened(const Corners& corners, const Frame& frame, double merge_mm) {
  FlatPolygon polygon;
  for (const Vec3& p : corners) add_corner(polygon, frame.across(p), merge_mm);
  close(polygon, merge_mm);
  if (area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
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

double mean_transmission(const Corners& corners, const PathLength& path_length, double absorption_per_mm) {
  if (absorption_per_mm <= 0.0) return 1.0;
  const auto depth = [&](std::size_t k) { return absorption_per_mm * path_length.at(corners[k]); };
  const double first = depth(0);
  const double at_first = std::exp(-first);
  double sum = 0.0;
  double whole = 0.0;
  double before = depth(1);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const double here = depth(k);
    const double weight = (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]).norm();
    const bool is_narrow = std::abs(before - first) <= kNarrow && std::abs(here - first) <= kNarrow;
    sum +=
        weight * (is_narrow ? at_first * mean_exp_narrow(before - first, here - first) : mean_exp(first, before, here));
    whole += weight;
    before = here;
  }
  return whole > 0.0 ? sum / whole : at_first;
}

}  // namespace retrace::raytrace
