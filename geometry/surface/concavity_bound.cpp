#include "geometry/surface/concavity_bound.h"

#include <algorithm>
#include <cmath>

#include "core/math/interval.h"

namespace retrace::geometry {
namespace {

using jets::Series;

using Enclosure = Series<Interval, 2>;

constexpr int kDeepest = 6;  ///< maximum number of times that a box is halved along each side

/// Returns an upper bound of the larger eigenvalue of a symmetric matrix. The eigenvalue increases with the diagonal
/// and with the magnitude of the off-diagonal element.
double largest_eigenvalue(const Interval& xx, const Interval& xy, const Interval& yy) {
  const double a = xx.upper();
  const double d = yy.upper();
  return 0.5 * (a + d) + std::hypot(0.5 * (a - d), norm(xy));
}

/// Enclosures of height, slopes and second derivatives of a sag over a box.
struct Bend {
  Interval z;
  Interval x;
  Interval y;
  double largest = 0.0;  ///< maximum second derivative in any direction; NaN if undefined
};

Bend bend_over(const Sag& sag, const Interval& x, const Interval& y) {
  const auto along = [&](double c, double s) {
    return sag.evaluate_without_formula(Enclosure(x, Interval(c), Interval(0.0)),
                                        Enclosure(y, Interval(s), Interval(0.0)));
  };
  const Enclosure by_x = along(1.0, 0.0);
  const Enclosure by_y = along(0.0, 1.0);
  const Interval xy = along(1.0, 1.0)[2] - by_x[2] - by_y[2];
  return {by_x[0], by_x[1], by_y[1], largest_eigenvalue(2.0 * by_x[2], xy, 2.0 * by_y[2])};
}

Interval along_x(const PlanBox& box) {
  return {box.low_mm.x(), box.high_mm.x()};
}
Interval along_y(const PlanBox& box) {
  return {box.low_mm.y(), box.high_mm.y()};
}

/// Returns half the side of a square about the origin of the lenslet's frame. The surface over this square covers the
/// disc of radius `reach_mm` about the origin in plan. A disc of radius rho in the lenslet's frame is sufficient if
/// cos(tilt) rho - sin(tilt) |w| > reach_mm, where w is the sag over this disc. Returns nothing if none of several
/// trial values of rho is sufficient.
std::optional<double> covering(const Lenslet& lenslet, double reach_mm) {
  const double cosine = lenslet.part_from_lenslet(2, 2);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  double rho = 1.001 * reach_mm / cosine;
  for (int attempt = 0; attempt < 4; ++attempt, rho *= 1.3) {
    const Interval span(-rho, rho);
    const Enclosure u(span, Interval(0.0), Interval(0.0));
    if (cosine * rho - sine * norm(lenslet.sag.evaluate_without_formula(u, u)[0]) > reach_mm) return rho;
  }
  return std::nullopt;
}

}  // namespace

void prove_by_subdivision(const PlanBox& box, int depth, const std::function<bool(const PlanBox&)>& holds,
                          const std::function<void(const PlanBox&)>& on_failure) {
  if (holds(box)) return;
  if (depth == 0) {
    on_failure(box);
    return;
  }
  const Vec2 middle = 0.5 * (box.low_mm + box.high_mm);
  for (const double x : {box.low_mm.x(), middle.x()})
    for (const double y : {box.low_mm.y(), middle.y()}) {
      const Vec2 high(x == middle.x() ? box.high_mm.x() : middle.x(), y == middle.y() ? box.high_mm.y() : middle.y());
      prove_by_subdivision({{x, y}, high}, depth - 1, holds, on_failure);
    }
}

void bound_concavity(const Sag& sag, const PlanBox& box, double limit_per_mm,
                     const std::function<bool(const PlanBox&)>& is_needed,
                     const std::function<void(const PlanBox&)>& on_failure) {
  if (sag.formula) {
    on_failure(box);
    return;
  }
  prove_by_subdivision(
      box, kDeepest,
      [&](const PlanBox& b) { return !is_needed(b) || bend_over(sag, along_x(b), along_y(b)).largest < limit_per_mm; },
      on_failure);
}

bool is_concavity_bounded(const Lenslet& lenslet, double limit_per_mm) {
  if (lenslet.sag.formula) return false;
  const Eigen::Matrix3d& r = lenslet.part_from_lenslet;
  const Vec2 offset = lenslet.inner.centre_mm - lenslet.origin_mm.head<2>();
  const auto rho = covering(lenslet, offset.norm() + lenslet.inner.max_radius_mm);
  if (!rho) return false;
  const auto holds = [&](const PlanBox& box) {
    const Bend bend = bend_over(lenslet.sag, along_x(box), along_y(box));
    // `upright` is the z component, in the part frame, of the normal n = (-h_u, -h_v, 1). It is the derivative of w - h
    // with respect to the part's z, where h(u, v) is the sag.
    const Interval upright = r(2, 2) - bend.x * r(2, 0) - bend.y * r(2, 1);
    if (!(upright.lower() > 0.0) || !std::isfinite(bend.largest)) return false;
    const double square = 1.0 + std::pow(norm(bend.x), 2) + std::pow(norm(bend.y), 2);
    // For a straight line in plan, the height above it has z'' = h'' / upright. The direction (u', v') of this line in
    // the lenslet's frame has at most the length |n| / upright.
    return std::max(0.0, bend.largest) * square / std::pow(upright.lower(), 3) < limit_per_mm;
  };
  bool is_proved = true;
  prove_by_subdivision({{-*rho, -*rho}, {*rho, *rho}}, 5, holds, [&](const PlanBox&) { is_proved = false; });
  return is_proved;
}

}  // namespace retrace::geometry
