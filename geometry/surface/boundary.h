#pragma once

// Closed curves in plan that bound a region of a surface. They are circles, rectangles, or curves through points, from
// formulas or from intersections of surfaces.

#include <functional>
#include <optional>
#include <vector>

#include "core/error.h"
#include "geometry/surface/periodic_spline.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Closed curve about a centre with one radius for each angle (N. J. Naples, A. Y. Yi, Toolpath generation: freeform
/// surface blending and extrapolation, section Boundaries).
struct Boundary {
  Vec2 centre_mm = Vec2::Zero();
  PeriodicSpline radius_mm = PeriodicSpline::constant(1.0);
  /// Minimum and maximum radius, estimated from samples of each spline segment. They allow contains() to answer
  /// quickly.
  double min_radius_mm = 1.0;
  double max_radius_mm = 1.0;

  Vec2 point_mm(double angle_rad) const {
    return centre_mm + radius_mm.evaluate(angle_rad) * Vec2(std::cos(angle_rad), std::sin(angle_rad));
  }
  /// Returns true if a point is inside the curve or on it (Naples and Yi, eq. 1).
  bool contains(double x_mm, double y_mm) const {
    const double dx = x_mm - centre_mm.x();
    const double dy = y_mm - centre_mm.y();
    const double r = std::hypot(dx, dy);
    if (r <= min_radius_mm) return true;
    return r <= max_radius_mm && r <= radius_mm.evaluate(std::atan2(dy, dx));
  }
};

/// Parameters of a boundary's spline.
struct BoundaryOptions {
  int degree = 3;     ///< degree of the spline, which is C^(degree - 1) in azimuth
  int samples = 180;  ///< number of samples of curves that are not given by points
};

/// Returns a boundary from radii at ascending angles.
/// \throw InputError if the spline through the radii is not positive everywhere, or if there are fewer than degree + 2
///     radii
Boundary boundary_from_radii(const Vec2& centre_mm, const std::vector<double>& angles_rad,
                             const std::vector<double>& radii_mm, int degree, const InputLocation& where);

/// Returns a boundary through points in plan.
/// \param points_mm points in order along the curve, in either direction
/// \param centre_mm centre of the boundary; if it has no value, the centroid of the enclosed area is the centre
/// \param scattered true if the points are in no particular order; they are then sorted by their angle about the centre
/// \throw InputError if the curve crosses itself or has several radii at one angle about the centre
Boundary boundary_from_points(std::vector<Vec2> points_mm, std::optional<Vec2> centre_mm, bool scattered, int degree,
                              const InputLocation& where);

/// Returns a boundary from a function r(theta), which is sampled.
/// \throw InputError if the radius is not finite or not positive
Boundary boundary_from_radius(const Vec2& centre_mm, const std::function<double(double)>& radius_mm,
                              const BoundaryOptions& options, const InputLocation& where);

Boundary circle_boundary(const Vec2& centre_mm, double radius_mm, int degree = 3);

/// Returns a sampled rectangle with rounded corners.
/// \pre corner_mm > 0
Boundary rectangle_boundary(const Vec2& centre_mm, double width_mm, double height_mm, double corner_mm,
                            const BoundaryOptions& options, const InputLocation& where);

/// Returns the curve in which two surfaces intersect. At each angle, its radius is the smallest radius up to `max_mm`
/// at which the difference of the two heights is 0.
/// \throw InputError with the angle, if the surfaces do not intersect at this angle
Boundary boundary_of_intersection(const Vec2& centre_mm, const std::function<double(double, double)>& difference_mm,
                                  double max_mm, const BoundaryOptions& options, const InputLocation& where);

/// Returns the boundary with the radii factor * r + offset_mm.
/// \throw InputError if a radius is then not positive
Boundary scaled(const Boundary& boundary, double factor, double offset_mm, const InputLocation& where);

/// Checks that `inner` is inside `outer`.
/// \pre both boundaries have the same centre
/// \throw InputError with an angle at which `inner` is not inside `outer`
void check_nested(const Boundary& inner, const Boundary& outer, const InputLocation& where);

}  // namespace retrace::geometry
