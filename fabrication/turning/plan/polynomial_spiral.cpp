#include "fabrication/turning/plan/polynomial_spiral.h"
#include "core/angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface;
using geometry::kMaxPolynomialDegree;
using geometry::Sag;
using geometry::XyPolynomial;

/// Surface along the radial line at one angle: coefficients of the powers of the distance from the centre. Also the
/// lateral position, on the nose, of the point of contact in the previous turn.
struct RadialPolynomial {
  std::array<double, kMaxPolynomialDegree + 1> c{};
  double aside_mm = 0.0;
};

RadialPolynomial radial_polynomial(const Sag& sag, double angle, int degree) {
  RadialPolynomial line;
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  if (sag.polynomial) {
    const XyPolynomial& p = *sag.polynomial;
    for (int i = 0; i <= p.degree; ++i)
      for (int j = 0; i + j <= p.degree; ++j)
        line.c[static_cast<std::size_t>(i + j)] +=
            p.coefficients[p.index(i, j)] * std::pow(cosine / p.scale_mm, i) * std::pow(sine / p.scale_mm, j);
  }
  for (std::size_t k = 0; k < sag.asphere.even.size() && 2 * static_cast<int>(k) + 4 <= degree; ++k)
    line.c[2 * k + 4] += sag.asphere.even[k];
  return line;
}

/// Returns an upper bound of the absolute second derivative within a distance of the centre.
double steepest_bend(const RadialPolynomial& line, int degree, double reach_mm) {
  double sum = 0.0;
  for (int k = 2; k <= degree; ++k)
    sum += std::abs(line.c[static_cast<std::size_t>(k)]) * k * (k - 1) * std::pow(reach_mm, k - 2);
  return sum;
}

/// Returns the height of the nose's lowest point at radius r. It is the maximum, over the lateral distance w, of p(r +
/// w) minus the height of the nose at w. This function is concave, so Newton's method finds its only maximum.
double touching_height(RadialPolynomial& line, int degree, double r, double nose_mm, double most_aside) {
  double w = line.aside_mm;
  for (int step = 0; step < 12; ++step) {
    const double x = r + w;
    double z = line.c[static_cast<std::size_t>(degree)];
    double slope = 0.0;
    double bend = 0.0;
    for (int k = degree - 1; k >= 0; --k) {
      bend = bend * x + slope;
      slope = slope * x + z;
      z = z * x + line.c[static_cast<std::size_t>(k)];
    }
    const double root = std::sqrt(nose_mm * nose_mm - w * w);
    const double inverse = 1.0 / root;
    const double g1 = slope - w * inverse;
    const double g2 = 2.0 * bend - nose_mm * nose_mm * inverse * inverse * inverse;
    const double next = std::clamp(w - g1 / g2, -most_aside, most_aside);
    const double change = next - w;
    w = next;
    // The remaining terms of the expansion are of third order in the change.
    if (std::abs(change) < 1e-6 * nose_mm) {
      line.aside_mm = w;
      return z - (nose_mm - root) + change * (g1 + 0.5 * change * g2);
    }
  }
  line.aside_mm = w;
  double z = line.c[static_cast<std::size_t>(degree)];
  for (int k = degree - 1; k >= 0; --k) z = z * (r + w) + line.c[static_cast<std::size_t>(k)];
  return z - (nose_mm - std::sqrt(nose_mm * nose_mm - w * w));
}

}  // namespace

std::optional<Pass> polynomial_spiral(const FreeformSurface& surface, const TurningTool& tool, const PathOptions& o) {
  const int even = static_cast<int>(surface.base().asphere.even.size());
  const int degree =
      std::max({1, surface.base().polynomial ? surface.base().polynomial->degree : 0, even > 0 ? 2 * even + 2 : 0});
  if (!surface.is_polynomial_everywhere() || degree > kMaxPolynomialDegree || o.sampling != Sampling::angle ||
      tool.skew_deg != 0.0 || tool.rake_deg != 0.0)
    return std::nullopt;
  const double start = o.radius_mm + o.overrun_mm;
  std::vector<RadialPolynomial> lines;
  for (int i = 0; i < o.points_per_turn; ++i) {
    // C increases, and the angle of the tool in the part decreases.
    lines.push_back(radial_polynomial(surface.base(), -kTwoPi * i / o.points_per_turn, degree));
    if (steepest_bend(lines.back(), degree, start + tool.nose_radius_mm) * tool.nose_radius_mm > 0.99)
      return std::nullopt;
  }
  const auto whole = static_cast<std::size_t>(std::floor(start / o.feed_mm * o.points_per_turn + 1e-9));
  const double step_s = 60.0 / o.spindle_rpm / o.points_per_turn;
  const double most_aside =
      tool.nose_radius_mm * std::min(0.9999, std::sin(0.5 * tool.window_deg * std::numbers::pi / 180.0));
  Pass pass(whole + 1);
  std::size_t line = 0;
  for (std::size_t i = 0; i <= whole; ++i) {
    const double turns = static_cast<double>(i) / o.points_per_turn;
    PathPoint& p = pass[i];
    p.x_mm = start - o.feed_mm * turns;
    p.c_deg = 360.0 * turns;
    p.seconds = i == 0 ? 0.0 : step_s;
    p.z_mm = touching_height(lines[line], degree, p.x_mm, tool.nose_radius_mm, most_aside);
    line = line + 1 < lines.size() ? line + 1 : 0;
  }
  return pass;
}

}  // namespace retrace::fabrication::turning
