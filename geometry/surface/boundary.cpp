#include "geometry/surface/boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <span>

#include "core/angle.h"
#include "core/number_format.h"
#include "geometry/centroid.h"

namespace retrace::geometry {
namespace {

std::string degrees(double angle_rad) {
  return fixed(std::remainder(angle_rad, kTwoPi) * 180.0 / std::numbers::pi, 2);
}

/// Estimates the minimum and maximum radius from the ends and several points of each spline segment.
void measure(Boundary& boundary, const InputLocation& where) {
  const std::vector<double>& knots = boundary.radius_mm.knots_rad();
  constexpr int kPlaces = 16;
  boundary.min_radius_mm = std::numeric_limits<double>::infinity();
  boundary.max_radius_mm = 0.0;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double next = i + 1 < knots.size() ? knots[i + 1] : knots.front() + kTwoPi;
    for (int k = 0; k < kPlaces; ++k) {
      const double angle = knots[i] + (next - knots[i]) * k / kPlaces;
      const double r = boundary.radius_mm.evaluate(angle);
      if (!(r > 0.0))
        throw InputError(where, fmt::format("must have a radius > 0 at every angle about its centre, but at {} degrees "
                                            "its spline has a radius of {} mm",
                                            degrees(angle), shortest(r)));
      boundary.min_radius_mm = std::min(boundary.min_radius_mm, r);
      boundary.max_radius_mm = std::max(boundary.max_radius_mm, r);
    }
  }
  // Between these points, the radius may slightly exceed the range. A margin is therefore added.
  const double margin = 1e-3 * (boundary.max_radius_mm - boundary.min_radius_mm);
  boundary.min_radius_mm -= std::min(margin, 0.5 * boundary.min_radius_mm);
  boundary.max_radius_mm += margin;
}

/// Returns the angles of points about the centre. Each angle differs from the previous angle by at most half a turn.
std::vector<double> unwound(const std::vector<Vec2>& points, const Vec2& centre) {
  std::vector<double> angles;
  for (const Vec2& p : points) {
    const double angle = std::atan2(p.y() - centre.y(), p.x() - centre.x());
    angles.push_back(angles.empty() ? angle : angles.back() + std::remainder(angle - angles.back(), kTwoPi));
  }
  return angles;
}

/// Returns the mean of the points, which is always inside their convex hull.
Vec2 inner_point(const std::vector<Vec2>& points) {
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : points) mean += p / static_cast<double>(points.size());
  return mean;
}

/// Sorts scattered points by their angle about a centre.
void sort_by_angle(std::vector<Vec2>& points, const Vec2& centre) {
  std::sort(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
    return std::atan2(a.y() - centre.y(), a.x() - centre.x()) < std::atan2(b.y() - centre.y(), b.x() - centre.x());
  });
}

/// Checks that the angles ascend through exactly one full turn.
void check_single_valued(const std::vector<double>& angles, const InputLocation& where) {
  const double closing = angles.back() + std::remainder(angles.front() - angles.back(), kTwoPi);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : closing;
    if (!(next - angles[i] > 1e-12))
      throw InputError(where, fmt::format("the boundary must not cross itself and must have only one radius at each "
                                          "angle about its centre, but the angle reverses at point {} ({} degrees)",
                                          i + 1, degrees(angles[i])));
  }
  if (std::abs(closing - angles.front() - kTwoPi) > 1e-9)
    throw InputError(where,
                     fmt::format("the boundary must enclose its centre exactly one time, but encloses it {} times",
                                 std::lround((closing - angles.front()) / kTwoPi)));
}

}  // namespace

Boundary boundary_from_radii(const Vec2& centre_mm, const std::vector<double>& angles_rad,
                             const std::vector<double>& radii_mm, int degree, const InputLocation& where) {
  Boundary boundary;
  boundary.centre_mm = centre_mm;
  try {
    boundary.radius_mm = PeriodicSpline(angles_rad, radii_mm, degree);
  } catch (const std::invalid_argument& error) {
    throw InputError(where,
                     fmt::format("must have at least {} points at different angles for a spline of degree {} ({})",
                                 degree + 2, degree, error.what()));
  }
  measure(boundary, where);
  return boundary;
}

Boundary boundary_from_points(std::vector<Vec2> points_mm, std::optional<Vec2> centre_mm, bool scattered, int degree,
                              const InputLocation& where) {
  if (points_mm.size() < static_cast<std::size_t>(degree) + 2)
    throw InputError(where, fmt::format("must have at least {} points for a spline of degree {}, got {}", degree + 2,
                                        degree, points_mm.size()));
  if (scattered) sort_by_angle(points_mm, centre_mm.value_or(inner_point(points_mm)));
  const Vec2 centre = centre_mm.value_or(centroid(std::span<const Vec2>(points_mm)));
  for (std::size_t i = 0; i < points_mm.size(); ++i)
    if (!((points_mm[i] - centre).norm() > 0.0))
      throw InputError(where,
                       fmt::format("must have a radius > 0 at every angle, but point {} is at the centre", i + 1));
  if (scattered) sort_by_angle(points_mm, centre);
  std::vector<double> angles = unwound(points_mm, centre);
  if (angles.back() < angles.front()) {
    std::reverse(points_mm.begin(), points_mm.end());
    angles = unwound(points_mm, centre);
  }
  check_single_valued(angles, where);
  std::vector<double> radii;
  for (const Vec2& p : points_mm) radii.push_back((p - centre).norm());
  return boundary_from_radii(centre, angles, radii, degree, where);
}

Boundary boundary_from_radius(const Vec2& centre_mm, const std::function<double(double)>& radius_mm,
                              const BoundaryOptions& options, const InputLocation& where) {
  std::vector<double> angles;
  std::vector<double> radii;
  for (int i = 0; i < options.samples; ++i) {
    angles.push_back(kTwoPi * i / options.samples - std::numbers::pi);
    radii.push_back(radius_mm(angles.back()));
    if (!(radii.back() > 0.0) || !std::isfinite(radii.back()))
      throw InputError(
          where, fmt::format("must give a finite radius > 0 at every angle, but at {} degrees it gives {}",
                             degrees(angles.back()), std::isfinite(radii.back()) ? shortest(radii.back()) : "none"));
  }
  return boundary_from_radii(centre_mm, angles, radii, options.degree, where);
}

Boundary circle_boundary(const Vec2& centre_mm, double radius_mm, int degree) {
  Boundary boundary;
  boundary.centre_mm = centre_mm;
  boundary.radius_mm = PeriodicSpline::constant(radius_mm, degree);
  // A spline through equal values is constant except for rounding errors.
  boundary.min_radius_mm = radius_mm * (1.0 - 1e-12);
  boundary.max_radius_mm = radius_mm * (1.0 + 1e-12);
  return boundary;
}

Boundary rectangle_boundary(const Vec2& centre_mm, double width_mm, double height_mm, double corner_mm,
                            const BoundaryOptions& options, const InputLocation& where) {
  const double a = 0.5 * width_mm;
  const double b = 0.5 * height_mm;
  const double c = std::min(corner_mm, std::min(a, b));
  const auto radius = [=](double angle) {
    const double x = std::abs(std::cos(angle));
    const double y = std::abs(std::sin(angle));
    const double to_side = std::min(x > 0.0 ? a / x : 1e300, y > 0.0 ? b / y : 1e300);
    if (to_side * x <= a - c || to_side * y <= b - c) return to_side;
    // Point on the circle of the rounded corner, whose centre is (a - c, b - c). The radius is the larger root of |r
    // (x, y) - centre| = c.
    const double along = x * (a - c) + y * (b - c);
    const double across = x * (b - c) - y * (a - c);
    return along + std::sqrt(std::max(0.0, c * c - across * across));
  };
  return boundary_from_radius(centre_mm, radius, options, where);
}

Boundary boundary_of_intersection(const Vec2& centre_mm, const std::function<double(double, double)>& difference_mm,
                                  double max_mm, const BoundaryOptions& options, const InputLocation& where) {
  constexpr int kSteps = 256;
  const auto radius = [&](double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const auto f = [&](double r) { return difference_mm(centre_mm.x() + r * c, centre_mm.y() + r * s); };
    double low = max_mm / kSteps;
    double f_low = f(low);
    for (int i = 2; i <= kSteps; ++i) {
      double high = max_mm * i / kSteps;
      const double f_high = f(high);
      if (f_low == 0.0) return low;
      if ((f_low < 0.0) != (f_high < 0.0) && std::isfinite(f_high)) {
        while (high - low > 1e-15 * max_mm) {
          const double middle = 0.5 * (low + high);
          if (middle <= low || middle >= high) break;
          const double value = f(middle);
          ((value < 0.0) == (f_low < 0.0) ? low : high) = middle;
        }
        return 0.5 * (low + high);
      }
      low = high;
      f_low = f_high;
    }
    throw InputError(
        where,
        fmt::format("must intersect the base at every angle, but at {} degrees there is no intersection within {} mm",
                    degrees(angle), shortest(max_mm)));
  };
  return boundary_from_radius(centre_mm, radius, options, where);
}

Boundary scaled(const Boundary& boundary, double factor, double offset_mm, const InputLocation& where) {
  Boundary result = boundary;
  result.radius_mm = boundary.radius_mm.mapped(factor, offset_mm);
  measure(result, where);
  return result;
}

void check_nested(const Boundary& inner, const Boundary& outer, const InputLocation& where) {
  constexpr int kAngles = 4096;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = kTwoPi * i / kAngles;
    const double r = inner.radius_mm.evaluate(angle);
    const double R = outer.radius_mm.evaluate(angle);
    if (!(r < R))
      throw InputError(
          where,
          fmt::format("must not cross or touch the boundary around it, but at {} degrees their radii are {} and {} mm",
                      degrees(angle), fixed(r, 6), fixed(R, 6)));
  }
}

}  // namespace retrace::geometry
