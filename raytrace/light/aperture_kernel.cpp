#include "raytrace/light/aperture_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::raytrace {
namespace {

using std::numbers::pi;

// Ratio of radii below which the smaller disc is treated as a point.
constexpr double kPoint = 1e-9;
// Number of integration points along a radius, per angular width of the finest details of the integrand. With 2.5
// points, the error of the mean is below 3e-5 of the maximum. With 2 points, it is 2e-3. kFewest and kMost are the
// minimum and the maximum number of points.
constexpr double kPointsAlongADetail = 2.5;
constexpr double kFewest = 6.0;
constexpr double kMost = 96.0;

double half_chord_angle(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

std::size_t points_along(double length_rad, double detail_rad) {
  return static_cast<std::size_t>(std::clamp(kPointsAlongADetail * length_rad / detail_rad, kFewest, kMost));
}

/// Returns the number of uniform steps on a ring. The mean of a wave over the ring is a Bessel function of order 0 of
/// x. With n uniform steps, the error of this mean is a Bessel function of order n. The error decreases rapidly if n
/// exceeds x by several times x^(1/3).
std::size_t points_round(double radius_rad, double detail_rad) {
  const double x = 2.0 * pi * radius_rad / detail_rad;
  return static_cast<std::size_t>(std::clamp(std::ceil(x + 4.0 * std::cbrt(x)), kFewest, 4.0 * kMost));
}

}  // namespace

double disc_transform(double x) {
  const double x2 = x * x;
  return x2 < 1e-4 ? 1.0 - x2 / 8.0 : 2.0 * std::cyl_bessel_j(1.0, x) / x;
}

GaussRule gauss_legendre(std::size_t count) {
  GaussRule rule{std::vector<double>(count), std::vector<double>(count)};
  const double n = static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    // Newton's method with Tricomi's approximation of the root as start; Press et al., Numerical Recipes, 4.6.
    double x = std::cos(pi * (static_cast<double>(k) + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double before = 1.0;
      double value = x;
      for (std::size_t j = 2; j <= count; ++j) {
        const double m = static_cast<double>(j);
        const double next = ((2.0 * m - 1.0) * x * value - (m - 1.0) * before) / m;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1.0);
      const double step = value / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.nodes[count - 1 - k] = 0.5 * (1.0 + x);
    rule.weights[count - 1 - k] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return rule;
}

ApertureKernel::ApertureKernel(const PhotometricApertures& apertures)
    : larger_rad_(0.5 * std::max(apertures.source.rad(), apertures.receiver.rad())),
      smaller_rad_(0.5 * std::min(apertures.source.rad(), apertures.receiver.rad())),
      source_rad_(0.5 * apertures.source.rad()),
      receiver_rad_(0.5 * apertures.receiver.rad()) {
  if (smaller_rad_ < kPoint * larger_rad_) smaller_rad_ = 0.0;
}

double ApertureKernel::per_sr(double separation_rad) const {
  const double a = larger_rad_;
  const double b = smaller_rad_;
  const double d = std::abs(separation_rad);
  if (d >= a + b) return d == a && b == 0.0 ? 1.0 / (pi * a * a) : 0.0;
  if (d <= a - b) return 1.0 / (pi * a * a);
  const double at_a = half_chord_angle((d * d + a * a - b * b) / (2.0 * d * a));
  const double at_b = half_chord_angle((d * d + b * b - a * a) / (2.0 * d * b));
  // The overlap of two discs consists of two circular segments.
  const double common = a * a * (at_a - 0.5 * std::sin(2.0 * at_a)) + b * b * (at_b - 0.5 * std::sin(2.0 * at_b));
  return common / (pi * a * a * pi * b * b);
}

double ApertureKernel::transform(double rad_per_rad) const {
  // The kernel is the convolution of two discs, and its transform is therefore a product.
  return disc_transform(larger_rad_ * rad_per_rad) * disc_transform(smaller_rad_ * rad_per_rad);
}

std::vector<ApertureKernel::Node> ApertureKernel::nodes(double detail_rad) const {
  std::vector<Node> nodes;
  double sum = 0.0;
  const double kink = larger_rad_ - smaller_rad_;
  for (const auto& [from, to] : {std::pair{0.0, kink}, std::pair{kink, reach_rad()}}) {
    if (!(to > from)) continue;
    const GaussRule radial = gauss_legendre(points_along(to - from, detail_rad));
    for (std::size_t k = 0; k < radial.nodes.size(); ++k) {
      const double r = std::lerp(from, to, radial.nodes[k]);
      const std::size_t round = points_round(r, detail_rad);
      const double weight = radial.weights[k] * (to - from) * r * per_sr(r) * 2.0 * pi / static_cast<double>(round);
      for (std::size_t j = 0; j < round; ++j) {
        // Each ring is rotated relative to the preceding one, so that no direction is preferred.
        const double turn = 2.0 * pi * (static_cast<double>(j) + std::numbers::phi * static_cast<double>(k)) /
                            static_cast<double>(round);
        nodes.push_back({{r * std::cos(turn), r * std::sin(turn)}, weight});
        sum += weight;
      }
    }
  }
  for (Node& node : nodes) node.weight /= sum;
  return nodes;
}

}  // namespace retrace::raytrace
