#pragma once

// Tangent planes of a curved entrance surface. The light of one element is traced through the tangent plane, and the
// distance of the surface from this plane changes its phase (docs/theory/fronts.md).

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "surface_models/facet_form.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Tangent plane of an entrance surface, with a frame whose z axis is the normal of the surface at the tangent point.
/// The frame is rotated from the part frame about the axis that is perpendicular to z of both frames.
struct TangentPlane {
  Vec3 point_mm = Vec3::Zero();       ///< tangent point in the part frame
  Vec3 normal = Vec3::UnitZ();        ///< out of the part
  Vec2 surface_slope = Vec2::Zero();  ///< slope of the surface at the tangent point, in the part frame
  Eigen::Matrix3d frame_from_part = Eigen::Matrix3d::Identity();  ///< rotation

  Vec3 to_frame(const Vec3& p) const { return frame_from_part * (p - point_mm); }
  Vec3 to_part(const Vec3& p) const { return point_mm + frame_from_part.transpose() * p; }
};

/// Returns the tangent plane at a point of the surface, or nothing if the surface has no finite height and slope there.
std::optional<TangentPlane> tangent_plane(const geometry::EntranceSurface& surface, const Vec2& at_mm);

/// Returns the unit direction inside the part of light that a surface refracts.
/// \param slope slope of the surface
/// \param index refractive index of the part, > 1
Vec3 refracted_inside(const Vec2& slope, const Vec3& to_source, double index);

/// Returns the (x, y) of the point where light must enter to be refracted towards a point inside the part. Returns
/// nothing if the search does not converge, or leaves the region in which the surface is defined.
std::optional<Vec2> point_of_entry(const geometry::EntranceSurface& surface, const Vec3& target_mm,
                                   const Vec3& to_source, double index);

/// Returns the illuminance behind the surface, divided by the illuminance behind its tangent plane. The illuminance is
/// that on a horizontal plane, and follows from the directions in which neighbouring light is refracted. Returns
/// nothing if the surface is not defined around the tangent point, or if light crosses before it reaches the plane.
/// \param height_mm height of the horizontal plane
/// \param step_mm distance of the neighbouring light
std::optional<double> concentration(const geometry::EntranceSurface& surface, const TangentPlane& plane,
                                    const Vec3& to_source, double index, double height_mm, double step_mm);

/// Returns the height that a ray towards the source gains over a plane, per length of the ray. Multiplied by an area in
/// plan, it is the cross section of the light that crosses the plane in this area.
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
  /// Term coefficient * x^i y^j.
  struct Term {
    int i = 0, j = 0;
    double coefficient = 0.0;  ///< in mm^(1 - i - j)
  };
  std::vector<Term> terms;         ///< i + j >= 2
  surface_models::FacetForm form;  ///< sum of the terms, in the frame of the tangent plane
  double error_mm = 0.0;           ///< maximum difference from the surface at the sample points
};
/// Fits a polynomial to the height of a surface above its tangent plane within a square about the tangent point. Points
/// where the surface is not defined are ignored. Returns nothing if too few points remain.
std::optional<SurfaceSag> fitted_sag(const geometry::EntranceSurface& surface, const TangentPlane& plane,
                                     double half_width_mm);

/// Returns the squared slope of a surface across the direction of light, as a polynomial of the point where the light
/// meets the tangent plane. Terms of the surface above degree 5 are ignored.
/// \param per_height horizontal displacement of the light per change of height, in the frame of the tangent plane
surface_models::FacetForm squared_slope(const SurfaceSag& sag, const Vec2& per_height);

}  // namespace retrace::raytrace
