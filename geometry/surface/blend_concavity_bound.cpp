#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/math/interval.h"
#include "core/math/jets.h"
#include "geometry/surface/concavity_bound.h"

// Between its two boundaries, a blend is a polynomial in the relative position v. Its values are between the smallest
// and the largest coefficient of its Bernstein form. Its derivatives are bounded in the same way by differences of the
// coefficients (G. Farin, Curves and Surfaces for CAGD, 5th ed., sections 5.3 and 6.3). Interval arithmetic encloses
// the coefficients over intervals of the azimuth.

namespace retrace::geometry {
namespace {

using jets::binomial;
using jets::constant_like;
using jets::horner;
using jets::Jet2;
using jets::line_series;
using jets::Series;

constexpr int kMaxDegree = 2 * kMaxBlendOrder + 1;
constexpr int kHalvings = 4;

/// One polynomial piece of a spline, with its coefficients.
struct Piece {
  double start_rad = 0.0;
  const double* coefficients = nullptr;
  int count = 0;
};

Piece piece_of(const PeriodicSpline& spline, double angle_rad) {
  const std::vector<double>& knots = spline.knots_rad();
  const double turns = std::floor((angle_rad - knots.front()) / kTwoPi);
  const auto after = std::upper_bound(knots.begin(), knots.end(), angle_rad - turns * kTwoPi);
  const auto index = static_cast<std::size_t>(after - knots.begin()) - 1;
  return {knots[index] + turns * kTwoPi, spline.piece(index), spline.degree() + 1};
}

/// Blend along a radial line, and its dependence on the azimuth. C is double or Interval. The members are Taylor series
/// in the azimuth.
template <class C>
struct Ray {
  Series<C, 2> inner;
  Series<C, 2> width;
  std::array<Series<C, 2>, kMaxDegree + 1> node;  ///< Bernstein coefficients of z
};

/// Returns the height on the lenslet along a line, in doubles. The result always has a value. It is optional only
/// because the overload for enclosures below may fail.
template <int N>
std::optional<Series<Jet2, N>> on_lenslet(const Lenslet& lenslet, const Series<Jet2, N>& x, const Series<Jet2, N>& y) {
  return lenslet.evaluate(x, y);
}

using Enclosure = Series<Interval, 2>;

/// Enclosure of the lenslet's surface over a box in plan. It is computed with the interval Newton method (R. E. Moore,
/// Methods and Applications of Interval Analysis, SIAM 1979, section 5.2). The method also proves that exactly one such
/// height exists nearby.
struct Enclosed {
  Interval z;
  Interval slope;
};
std::optional<Enclosed> enclosed_height(const Lenslet& lenslet, const Interval& x, const Interval& y) {
  const Eigen::Matrix3d& r = lenslet.part_from_lenslet;
  const Vec3& o = lenslet.origin_mm;
  const double middle = lenslet.evaluate(median(x) + o.x(), median(y) + o.y()) - o.z();
  if (!std::isfinite(middle)) return std::nullopt;
  const auto residual_and_slope = [&](const Interval& z) {
    const Enclosure u(x * r(0, 0) + y * r(1, 0) + z * r(2, 0), Interval(r(2, 0)), Interval(0.0));
    const Enclosure v(x * r(0, 1) + y * r(1, 1) + z * r(2, 1), Interval(r(2, 1)), Interval(0.0));
    const Enclosure sag = lenslet.sag.evaluate_without_formula(u, v);
    return Enclosed{x * r(0, 2) + y * r(1, 2) + z * r(2, 2) - sag[0], r(2, 2) - sag[1]};
  };
  const Enclosed at_middle = residual_and_slope(Interval(middle));
  double reach = 1.5 * norm(at_middle.z) / r(2, 2) + 1e-15;
  for (int attempt = 0; attempt < 4; ++attempt, reach *= 2.0) {
    const Interval trial(middle - reach, middle + reach);
    const Interval slope = residual_and_slope(trial).slope;
    if (!(slope.lower() > 0.0)) return std::nullopt;
    const Interval next = middle - at_middle.z / slope;
    if (next.lower() > trial.lower() && next.upper() < trial.upper()) return Enclosed{next, slope};
  }
  return std::nullopt;
}

/// Returns enclosures of the height on the lenslet and of its derivatives. Derivatives are computed order by order.
/// Each derivative of the residual is 0 and depends linearly on the derivative of the height of the same order.
template <int N>
std::optional<Series<Enclosure, N>> on_lenslet(const Lenslet& lenslet, const Series<Enclosure, N>& x,
                                               const Series<Enclosure, N>& y) {
  const Eigen::Matrix3d& r = lenslet.part_from_lenslet;
  const Series<Enclosure, N> px = x - lenslet.origin_mm.x();
  const Series<Enclosure, N> py = y - lenslet.origin_mm.y();
  if (r(2, 2) == 1.0) return lenslet.sag.evaluate_without_formula(px, py) + lenslet.origin_mm.z();
  const auto start = enclosed_height(lenslet, px[0][0], py[0][0]);
  if (!start) return std::nullopt;
  Series<Enclosure, N> z = constant_like(px, 0.0);
  z[0][0] = start->z;
  constexpr int kOrdersOfAzimuth = 2;
  for (int order = 1; order <= z.order + kOrdersOfAzimuth; ++order) {
    const Series<Enclosure, N> u = px * r(0, 0) + py * r(1, 0) + z * r(2, 0);
    const Series<Enclosure, N> v = px * r(0, 1) + py * r(1, 1) + z * r(2, 1);
    Series<Enclosure, N> residual =
        px * r(0, 2) + py * r(1, 2) + z * r(2, 2) - lenslet.sag.evaluate_without_formula(u, v);
    for (int k = std::max(0, order - kOrdersOfAzimuth); k <= std::min<int>(order, z.order); ++k)
      z[k][order - k] = -(residual[k][order - k] / start->slope);
  }
  return z + lenslet.origin_mm.z();
}

template <int N, class C>
std::optional<Ray<C>> ray_of_order(const Lenslet& lenslet, const Sag& base, const C& angle_rad, const Piece& inner,
                                   const Piece& outer) {
  using T = Series<C, 2>;
  constexpr int d = N;
  constexpr int n = 2 * d + 1;
  const T angle(angle_rad, C(1.0), C(0.0));
  const T cosine = cos(angle);
  const T sine = sin(angle);
  const auto radius = [&](const Piece& p) { return horner(p.coefficients, p.count, angle - p.start_rad); };
  Ray<C> ray;
  ray.inner = radius(inner);
  const T far = radius(outer);
  ray.width = far - ray.inner;
  const Vec2& centre = lenslet.outer.centre_mm;
  const auto line = [&](const T& at, const T& direction, double c) {
    return line_series<T, N>(T(at * direction + c), direction, d);
  };
  const auto first = on_lenslet(lenslet, line(ray.inner, cosine, centre.x()), line(ray.inner, sine, centre.y()));
  if (!first) return std::nullopt;
  const Series<T, N> second = base.evaluate_without_formula(line(far, cosine, centre.x()), line(far, sine, centre.y()));
  for (int j = 0; j <= d; ++j) {
    T from_first = constant_like(angle, 0.0);
    T from_second = constant_like(angle, 0.0);
    T scale = constant_like(angle, 1.0);
    for (int k = 0; k <= j; ++k) {
      const double share = binomial(j, k) / binomial(n, k);
      from_first = from_first + (*first)[k] * scale * share;
      from_second = from_second + second[k] * scale * (k % 2 == 0 ? share : -share);
      scale = scale * ray.width;
    }
    ray.node[static_cast<std::size_t>(j)] = from_first;
    ray.node[static_cast<std::size_t>(n - j)] = from_second;
  }
  return ray;
}

template <class C>
std::optional<Ray<C>> ray_at(const Lenslet& lenslet, const Sag& base, const C& angle_rad, const Piece& inner,
                             const Piece& outer) {
  switch (lenslet.blend_order) {
    case 1: return ray_of_order<1>(lenslet, base, angle_rad, inner, outer);
    case 2: return ray_of_order<2>(lenslet, base, angle_rad, inner, outer);
    case 3: return ray_of_order<3>(lenslet, base, angle_rad, inner, outer);
    default: return ray_of_order<kMaxBlendOrder>(lenslet, base, angle_rad, inner, outer);
  }
}

/// Returns the second derivative with respect to the radius, from the second difference of the nodes.
template <class C>
Series<C, 2> second_by_radius(const Ray<C>& ray, int degree, std::size_t j) {
  const double factor = static_cast<double>(degree * (degree - 1));
  return (ray.node[j + 2] - ray.node[j + 1] * 2.0 + ray.node[j]) / (ray.width * ray.width) * factor;
}

/// Returns an upper bound on [0, 1] of the polynomial with the given Bernstein coefficients, after several subdivisions
/// by de Casteljau's algorithm.
double above(std::array<double, kMaxDegree> node, int degree, int halvings) {
  if (halvings == 0) return *std::max_element(node.begin(), node.begin() + degree + 1);
  std::array<double, kMaxDegree> first{};
  for (int k = 0; k <= degree; ++k) {
    first[static_cast<std::size_t>(k)] = node[0];
    for (std::size_t j = 0; j < static_cast<std::size_t>(degree - k); ++j) node[j] = 0.5 * (node[j] + node[j + 1]);
  }
  // `node` now contains the second half in reversed order.
  return std::max(above(first, degree, halvings - 1), above(node, degree, halvings - 1));
}

/// Returns an upper bound of the second derivative on the radial lines in an interval of azimuth.
/// \param middle radial line at the centre of the interval; with it, only the second-order change of the nodes
///     (Bernstein coefficients) over the interval must be enclosed
double largest_bend(const Ray<Interval>& ray, const Ray<double>& middle, double half_rad, int degree) {
  const Interval share(0.0, 1.0);
  const Interval turn(-half_rad, half_rad);
  const Interval turn_squared(0.0, half_rad * half_rad);
  const auto at = [](int j) { return static_cast<std::size_t>(j); };
  Interval zrr = Interval::empty(), zv = zrr, slope = zrr, twist = zrr, bend = zrr;
  std::array<double, kMaxDegree> upper{};
  for (int j = 0; j <= degree; ++j) {
    slope = hull(slope, ray.node[at(j)][1]);
    bend = hull(bend, 2.0 * ray.node[at(j)][2]);
    if (j + 1 > degree) continue;
    zv = hull(zv, static_cast<double>(degree) * (ray.node[at(j + 1)][0] - ray.node[at(j)][0]));
    twist = hull(twist, static_cast<double>(degree) * (ray.node[at(j + 1)][1] - ray.node[at(j)][1]));
    if (j + 2 > degree) continue;
    const Jet2 centre = second_by_radius(middle, degree, at(j));
    const Enclosure whole = second_by_radius(ray, degree, at(j));
    const Interval second = intersect(whole[0], centre[0] + centre[1] * turn + whole[2] * turn_squared);
    zrr = hull(zrr, second);
    upper[at(j)] = second.upper();
  }
  // If the boundaries are not circles, v = (radius - inner) / width depends on the azimuth.
  const Interval& w = ray.width[0];
  const Interval v_t = -(ray.inner[1] + share * ray.width[1]) / w;
  const Interval v_tt = -(2.0 * (ray.inner[2] + share * ray.width[2])) / w - 2.0 * ray.width[1] * v_t / w;
  const Interval zvv = zrr * w * w;
  const Interval z_t = slope + zv * v_t;
  const Interval z_tt = bend + 2.0 * twist * v_t + zvv * v_t * v_t + zv * v_tt;
  const Interval z_rt = twist / w + zvv * v_t / w - zv * ray.width[1] / (w * w);
  const Interval radius = hull(ray.inner[0], ray.inner[0] + w);
  const Interval across = zv / w / radius + z_tt / (radius * radius);
  const Interval mixed = z_rt / radius - z_t / (radius * radius);
  // Bernstein polynomials are not negative, so the polynomial of the upper bounds is an upper bound.
  const double most = above(upper, degree - 2, 3);
  return 0.5 * (most + across.upper()) + std::hypot(0.5 * (most - across.upper()), norm(mixed));
}

bool is_proved_between(const Lenslet& lenslet, const Sag& base, double limit_per_mm, double from_rad, double to_rad,
                       int halvings) {
  const double middle = 0.5 * (from_rad + to_rad);
  const Piece inner = piece_of(lenslet.inner.radius_mm, middle);
  const Piece outer = piece_of(lenslet.outer.radius_mm, middle);
  const auto ray = ray_at(lenslet, base, Interval(from_rad, to_rad), inner, outer);
  if (ray && ray->inner[0].lower() > 0.0 && ray->width[0].lower() > 0.0) {
    const auto centre = ray_at(lenslet, base, middle, inner, outer);
    if (largest_bend(*ray, *centre, 0.5 * (to_rad - from_rad), 2 * lenslet.blend_order + 1) < limit_per_mm) return true;
  }
  return halvings > 0 && is_proved_between(lenslet, base, limit_per_mm, from_rad, middle, halvings - 1) &&
         is_proved_between(lenslet, base, limit_per_mm, middle, to_rad, halvings - 1);
}

/// Returns the angles at which a piece of a boundary begins, ascending within one turn. The first angle is repeated
/// after a full turn.
std::vector<double> breaks_of(const Lenslet& lenslet) {
  std::vector<double> breaks;
  const double start = lenslet.inner.radius_mm.knots_rad().front();
  for (const PeriodicSpline* spline : {&lenslet.inner.radius_mm, &lenslet.outer.radius_mm})
    for (const double knot : spline->knots_rad()) breaks.push_back(knot - kTwoPi * std::floor((knot - start) / kTwoPi));
  std::sort(breaks.begin(), breaks.end());
  breaks.push_back(breaks.front() + kTwoPi);
  return breaks;
}

/// Divides an interval into equal parts that are small enough for a proof. Returns true if all parts are proved.
bool is_proved_in_parts(const Lenslet& lenslet, const Sag& base, double limit_per_mm, double from_rad, double to_rad) {
  constexpr double kWidest = kTwoPi / 20.0;
  const int parts = static_cast<int>(std::ceil((to_rad - from_rad) / kWidest - 1e-9));
  const auto at = [&](int part) { return from_rad + (to_rad - from_rad) * part / parts; };
  for (int part = 0; part < parts; ++part)
    if (!is_proved_between(lenslet, base, limit_per_mm, at(part), at(part + 1), kHalvings)) return false;
  return true;
}

}  // namespace

bool is_blend_concavity_bounded(const Lenslet& lenslet, const Sag& base, double limit_per_mm) {
  // If the blend and the base have no common slope, the surface has a sharp edge at their boundary.
  if (lenslet.blend_order < 1 || !lenslet.ends_on_base || lenslet.sag.formula || base.formula) return false;
  const std::vector<double> breaks = breaks_of(lenslet);
  // an interval up to this length is a rounding error between equal knots of the two boundaries
  constexpr double kNone = 1e-12;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    if (breaks[i + 1] - breaks[i] > kNone && !is_proved_in_parts(lenslet, base, limit_per_mm, breaks[i], breaks[i + 1]))
      return false;
  return true;
}

}  // namespace retrace::geometry
