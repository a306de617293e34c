#include "surface_models/edge_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace retrace::surface_models {
namespace {

using Eigen::VectorXd;

constexpr double kNmPerMicrometre = 1e3;
constexpr double kMinEdgeAngle = 0.5 * std::numbers::pi / 180.0;

/// Measured points in um. For a valley, heights are mirrored, so that the edge is always convex.
struct Points {
  std::vector<double> x_um;
  std::vector<double> z_um;
};

/// Facets to the left and right of the edge: z = z0 + slope (x - x0), where slope = tan(tilt).
struct Facets {
  double x0_um = 0.0;  ///< x0 and z0: point at which the facets would meet
  double z0_um = 0.0;
  double left_rad = 0.0;  ///< tilts; left > right
  double right_rad = 0.0;

  double height(double x_um) const { return z0_um + (x_um - x0_um) * std::tan(x_um < x0_um ? left_rad : right_rad); }
};

/// Parameters of both shapes: x0, z0, left tilt, right tilt, then one or two sizes. The absolute value of a size is
/// used, so that the search may cross 0.
Facets facets_of(const VectorXd& p) {
  return {p[0], p[1], p[2], p[3]};
}

/// Returns the height of the facets with a circle of radius r that is tangent to both. The centre of the circle is on
/// the bisector below the edge. The tangent point on a facet of tilt t is at centre + r (-sin t, cos t).
double rounded_height(const VectorXd& p, double x_um) {
  const Facets f = facets_of(p);
  const double r = std::abs(p[4]);
  // The centre is at the distance r below both facets: z0 + (xc - x0) tan t - zc = r / cos t for both tilts.
  const double xc = f.x0_um + r * (1.0 / std::cos(f.right_rad) - 1.0 / std::cos(f.left_rad)) /
                                  (std::tan(f.right_rad) - std::tan(f.left_rad));
  const double zc = f.z0_um + (xc - f.x0_um) * std::tan(f.left_rad) - r / std::cos(f.left_rad);
  const double from = xc - r * std::sin(f.left_rad);
  const double to = xc - r * std::sin(f.right_rad);
  if (x_um <= from || x_um >= to) return f.height(x_um);
  const double d = x_um - xc;
  return zc + std::sqrt(std::max(0.0, r * r - d * d));
}

/// Returns the height of the facets with a flat from x0 - |p4| on the left facet to x0 + |p5| on the right facet.
double chamfered_height(const VectorXd& p, double x_um) {
  const Facets f = facets_of(p);
  const double from = f.x0_um - std::abs(p[4]);
  const double to = f.x0_um + std::abs(p[5]);
  if (x_um <= from || x_um >= to) return f.height(x_um);
  const double share = (x_um - from) / (to - from);
  return (1.0 - share) * f.height(from) + share * f.height(to);
}

double chamfer_width(const VectorXd& p) {
  const double left = std::abs(p[4]);
  const double right = std::abs(p[5]);
  return std::hypot(left + right, left * std::tan(p[2]) + right * std::tan(p[3]));
}

using Shape = double (*)(const VectorXd&, double);

/// Residuals in the form that Eigen's Levenberg-Marquardt method requires.
struct Residuals {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const Points* points;
  Shape shape;
  int parameters;

  int inputs() const { return parameters; }
  int values() const { return static_cast<int>(points->x_um.size()); }
  int operator()(const VectorXd& p, VectorXd& out) const {
    for (std::size_t i = 0; i < points->x_um.size(); ++i)
      out[static_cast<Eigen::Index>(i)] = shape(p, points->x_um[i]) - points->z_um[i];
    return 0;
  }
};

struct Solution {
  VectorXd parameters;
  double residual_nm = 0.0;
};

Solution solve(const Points& points, Shape shape, VectorXd start) {
  // The step of the numerical derivative is 1e-6 of a parameter. Only at few points does this step cross a kink of the
  // shape.
  Eigen::NumericalDiff<Residuals, Eigen::Central> residuals(Residuals{&points, shape, static_cast<int>(start.size())},
                                                            1e-12);
  Eigen::LevenbergMarquardt<decltype(residuals)> search(residuals);
  search.parameters.maxfev = 4000;
  search.parameters.xtol = 1e-12;
  search.parameters.ftol = 1e-14;
  search.minimize(start);
  VectorXd values(residuals.values());
  residuals(start, values);
  const auto freedom = static_cast<double>(std::max<Eigen::Index>(1, values.size() - start.size()));
  return {start, std::sqrt(values.squaredNorm() / freedom) * kNmPerMicrometre};
}

/// Returns the best of several searches with different initial sizes. A search with a poor initial value may end in a
/// local minimum.
template <class Start>
Solution best_of(const Points& points, Shape shape, double first_size, Start start) {
  Solution best;
  for (const double factor : {1.0, 0.3, 3.0}) {
    Solution next = solve(points, shape, start(factor * first_size));
    if (best.parameters.size() == 0 || next.residual_nm < best.residual_nm) best = std::move(next);
  }
  return best;
}

/// Fits a line to the points first..last. Returns its height at x = 0 and its slope.
std::array<double, 2> line_through(const Points& points, std::size_t first, std::size_t last) {
  double n = 0.0;
  double x = 0.0;
  double z = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    n += 1.0;
    x += points.x_um[i];
    z += points.z_um[i];
  }
  double xx = 0.0;
  double xz = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    xx += (points.x_um[i] - x / n) * (points.x_um[i] - x / n);
    xz += (points.x_um[i] - x / n) * (points.z_um[i] - z / n);
  }
  const double slope = xz / xx;
  return {(z - slope * x) / n, slope};
}

Points measured(const std::vector<double>& heights_nm, double pixel_um) {
  Points points;
  for (std::size_t i = 0; i < heights_nm.size(); ++i) {
    if (!std::isfinite(heights_nm[i])) continue;
    points.x_um.push_back(static_cast<double>(i) * pixel_um);
    points.z_um.push_back(heights_nm[i] / kNmPerMicrometre);
  }
  if (points.x_um.size() < kMinEdgePoints)
    throw std::invalid_argument("an edge requires at least 16 measured points across it");
  return points;
}

/// Returns initial facets from the outer fifths of the profile.
Facets first_facets(const Points& points) {
  const std::size_t fifth = std::max<std::size_t>(3, points.x_um.size() / 5);
  const auto [left_z, left_slope] = line_through(points, 0, fifth);
  const auto [right_z, right_slope] = line_through(points, points.x_um.size() - fifth, points.x_um.size());
  Facets f;
  f.left_rad = std::atan(left_slope);
  f.right_rad = std::atan(right_slope);
  if (std::abs(f.left_rad - f.right_rad) < kMinEdgeAngle)
    throw std::invalid_argument("the profile contains no edge: both of its ends have the same slope");
  f.x0_um = (right_z - left_z) / (left_slope - right_slope);
  f.z0_um = left_z + left_slope * f.x0_um;
  if (!(f.x0_um > points.x_um.front() && f.x0_um < points.x_um.back()))
    throw std::invalid_argument("the profile contains no edge: the facets do not meet within the profile");
  return f;
}

}  // namespace

EdgeFit fit_edge(const std::vector<double>& heights_nm, double pixel_um) {
  Points points = measured(heights_nm, pixel_um);
  Facets first = first_facets(points);
  const bool is_valley = first.left_rad < first.right_rad;
  if (is_valley) {
    for (double& z : points.z_um) z = -z;
    first = first_facets(points);
  }
  // Distance from the profile up to the point at which the facets would meet. The initial radius and flat follow from
  // this distance.
  const auto nearest = std::min_element(points.x_um.begin(), points.x_um.end(), [&](double a, double b) {
    return std::abs(a - first.x0_um) < std::abs(b - first.x0_um);
  });
  const double gap_um =
      std::max(1e-3 * pixel_um, first.z0_um - points.z_um[static_cast<std::size_t>(nearest - points.x_um.begin())]);
  const double half_turn = 0.5 * (first.left_rad - first.right_rad);
  const double radius = gap_um * std::cos(half_turn) / (1.0 - std::cos(half_turn));
  const double flat = gap_um / std::tan(half_turn);
  const auto start = [&](std::initializer_list<double> sizes) {
    VectorXd p(4 + static_cast<Eigen::Index>(sizes.size()));
    p.head<4>() << first.x0_um, first.z0_um, first.left_rad, first.right_rad;
    std::copy(sizes.begin(), sizes.end(), p.data() + 4);
    return p;
  };
  const Solution rounded = best_of(points, rounded_height, radius, [&](double r) { return start({r}); });
  const Solution chamfered = best_of(points, chamfered_height, flat, [&](double w) { return start({w, w}); });

  EdgeFit fit;
  fit.radius_um = std::abs(rounded.parameters[4]);
  fit.chamfer_um = chamfer_width(chamfered.parameters);
  fit.radius_residual_nm = rounded.residual_nm;
  fit.chamfer_residual_nm = chamfered.residual_nm;
  fit.better = chamfered.residual_nm < rounded.residual_nm ? EdgeShape::chamfer : EdgeShape::radius;
  const bool is_flat = fit.better == EdgeShape::chamfer;
  const VectorXd& p = (is_flat ? chamfered : rounded).parameters;
  const double turn_deg = (p[2] - p[3]) * 180.0 / std::numbers::pi;
  fit.dihedral_deg = is_valley ? 180.0 + turn_deg : 180.0 - turn_deg;
  const double sign = is_valley ? -1.0 : 1.0;
  for (std::size_t i = 0; i < heights_nm.size(); ++i) {
    const double x_um = static_cast<double>(i) * pixel_um;
    const double shape_um = is_flat ? chamfered_height(p, x_um) : rounded_height(p, x_um);
    fit.residual_nm.push_back(heights_nm[i] - sign * shape_um * kNmPerMicrometre);
  }
  return fit;
}

}  // namespace retrace::surface_models
