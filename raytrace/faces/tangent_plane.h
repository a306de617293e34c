#pragma once

// Tangent planes of a curved entrance surface. The light of each element is traced through one tangent plane. The
// distance between this plane and the surface is included as a change of the phase (docs/theory/fronts.md).

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "surface_models/facet_form.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Tangent plane of an entrance surface, with a frame whose z axis is the normal of the surface at the tangent point.
/// The rotation from the part frame to this frame is about the axis perpendicular to both z axes.
struct TangentPlane {
  Vec3 point_mm = Vec3::Zero();       ///< tangent point in the part frame
  Vec3 normal = Vec3::UnitZ();        ///< unit normal that points out of the part
  Vec2 surface_slope = Vec2::Zero();  ///< slope of the surface at the tangent point, in the part frame
  Eigen::Matrix3d frame_from_part = Eigen::Matrix3d::Identity();  ///< rotation

  Vec3 to_frame(const Vec3& p) const { return frame_from_part * (p - point_mm); }
  Vec3 to_part(const Vec3& p) const { return point_mm + frame_from_part.transpose() * p; }
};

/// Returns the tangent plane at a point of the surface, or nothing if the surface has no finite height and slope there.
std::optional<TangentPlane> tangent_plane(const geometry::EntranceSurface& surface, const Vec2& at_mm);

/// Returns the unit direction that light from the source has inside the part, after refraction at the surface.
/// \param slope slope of the surface
/// \param index refractive index of the part, > 1
Vec3 refracted_inside(const Vec2& slope, const Vec3& to_source, double index);

/// Returns x and y of the point of the surface at which light from the source must enter to reach the point `target_mm`
/// inside the part. Returns nothing if the search does not converge, or if it leaves the region in which the surface is
/// defined.
std::optional<Vec2> point_of_entry(const geometry::EntranceSurface& surface, const Vec3& target_mm,
                                   const Vec3& to_source, double index);

/// Returns the matrix K that describes how a curved surface shifts the points at which light enters. Consider light
/// that reaches a given point of a horizontal plane inside the part. Through the tangent plane, this light would enter
/// at the point e, relative to the tangent point. Through the curved surface, it enters at K e.
///
/// K is computed from neighbouring rays after refraction, in the frame of the tangent plane. Its determinant is the
/// illuminance behind the surface divided by the illuminance behind the tangent plane. Returns nothing if the surface
/// is not defined around the tangent point. Also returns nothing if the rays cross each other above the horizontal
/// plane.
/// \param height_mm height of the horizontal plane
/// \param step_mm distance from the tangent point to the neighbouring rays
std::optional<Eigen::Matrix2d> entry_displacement(const geometry::EntranceSurface& surface, const TangentPlane& plane,
                                                  const Vec3& to_source, double index, double height_mm,
                                                  double step_mm);

/// Returns the increase of the height above a plane, along z, per unit length of a ray towards the source. Light that
/// crosses the plane within an area in plan has a cross-section equal to this area times the returned value.
double rise_above(const geometry::TouchingPlane& plane, const Vec3& to_source);

/// Intersection of a line with the surface.
struct SurfacePoint {
  double distance_mm = 0.0;  ///< distance from the start of the line
  Vec3 point_mm = Vec3::Zero();
  Vec2 slope = Vec2::Zero();
};
/// Returns the intersection of a line with the surface near the start of the line (Newton's method), or nothing.
std::optional<SurfacePoint> nearest_intersection(const geometry::EntranceSurface& surface, const Vec3& start_mm,
                                                 const Vec3& direction);

/// Height of a surface above its tangent plane, as a polynomial.
struct SurfaceSag {
  /// The term coefficient * x^i * y^j.
  struct Term {
    int i = 0, j = 0;
    double coefficient = 0.0;  ///< in mm^(1 - i - j)
  };
  std::vector<Term> terms;         ///< i + j >= 2
  surface_models::FacetForm form;  ///< sum of the terms, in the frame of the tangent plane
  double error_mm = 0.0;           ///< maximum difference from the surface at the sample points

  /// Returns the matrix of second derivatives of the height at the tangent point.
  Eigen::Matrix2d curvature_per_mm() const;
};
/// Fits a polynomial to the height of a surface above its tangent plane within a square about the tangent point. Points
/// where the surface is not defined are ignored. Returns nothing if too few points remain.
std::optional<SurfaceSag> fitted_sag(const geometry::EntranceSurface& surface, const TangentPlane& plane,
                                     double half_width_mm);

/// Returns the squared gradient of the height of a surface above its tangent plane. The gradient is taken perpendicular
/// to the direction of the light. The result is a polynomial in the coordinates of the point where the light meets the
/// tangent plane. Terms of `sag` above degree 5 are ignored.
/// \param per_height displacement (x, y) of the light per unit increase of z, in the frame of the tangent plane
surface_models::FacetForm squared_slope(const SurfaceSag& sag, const Vec2& per_height);

}  // namespace retrace::raytrace
