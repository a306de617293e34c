#pragma once

// Closed curves in plan that bound what a surface says: circles, rectangles, points, formulas, intersections.

#include <functional>
#include <optional>
#include <vector>

#include "core/error.h"
#include "geometry/surface/periodic_spline.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// A closed curve round a centre with one radius for every angle (N. J. Naples, A. Y. Yi, Toolpath generation: freeform
/// surface blending and extrapolation, section Boundaries).
struct Boundary {
  Vec2 centre_mm = Vec2::Zero();
  PeriodicSpline radius_mm = PeriodicSpline::constant(1.0);
  double least_mm = 1.0;  ///< of the radius, found by sampling each piece, for quick answers
  double most_mm = 1.0;

  Vec2 point_mm(double angle_rad) const {
    return centre_mm + radius_mm.evaluate(angle_rad) * Vec2(std::cos(angle_rad), std::sin(angle_rad));
  }
  /// Inside, the curve included (their eq. 1).
  bool contains(double x_mm, double y_mm) const {
    const double dx = x_mm - centre_mm.x();
    const double dy = y_mm - centre_mm.y();
    const double r = std::hypot(dx, dy);
    if (r <= least_mm) return true;
    return r <= most_mm && r <= radius_mm.evaluate(std::atan2(dy, dx));
  }
};

/// How a boundary's spline is made.
struct BoundaryOptions {
  int degree = 3;     ///< of the spline: C^(degree - 1) in azimuth
  int samples = 180;  ///< of curves that are not given by points
};

/// A boundary from radii at rising angles. \throw InputError if the spline through them is not above 0 everywhere, or
/// if there are fewer than degree + 2
Boundary boundary_from_radii(const Vec2& centre_mm, const std::vector<double>& angles_rad,
                             const std::vector<double>& radii_mm, int degree, const InputLocation& where);

/// Returns a boundary through points.
/// \param points_mm points in order along the curve, in either direction
/// \param centre_mm centre of the boundary; if it has no value, the centroid of the enclosed area is the centre
/// \param scattered true if the points are in no particular order; they are then sorted by their angle about the centre
/// \throw InputError if the curve crosses itself or has several radii at one angle about the centre
Boundary boundary_from_points(std::vector<Vec2> points_mm, std::optional<Vec2> centre_mm, bool scattered, int degree,
                              const InputLocation& where);

/// A boundary from r(theta). \throw InputError where it is not finite or not above 0
Boundary boundary_from_radius(const Vec2& centre_mm, const std::function<double(double)>& radius_mm,
                              const BoundaryOptions& options, const InputLocation& where);

Boundary circle_boundary(const Vec2& centre_mm, double radius_mm, int degree = 3);

/// A rectangle with rounded corners, sampled. \pre corner > 0
Boundary rectangle_boundary(const Vec2& centre_mm, double width_mm, double height_mm, double corner_mm,
                            const BoundaryOptions& options, const InputLocation& where);

/// Where two surfaces meet, seen from the centre: the first radius up to `most_mm` at which their difference is 0.
/// \throw InputError at the angle where they do not meet
Boundary boundary_of_intersection(const Vec2& centre_mm, const std::function<double(double, double)>& difference_mm,
                                  double most_mm, const BoundaryOptions& options, const InputLocation& where);

/// The boundary with radii factor r + offset. \throw InputError if a radius is then not above 0
Boundary scaled(const Boundary& boundary, double factor, double offset_mm, const InputLocation& where);

/// \throw InputError with the angle at which `inner` does not lie inside `outer`. \pre the same centre
void check_nested(const Boundary& inner, const Boundary& outer, const InputLocation& where);

}  // namespace retrace::geometry
