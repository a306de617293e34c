#pragma once

// Facets with a form (a smooth deviation from the plane): the frame of a facet, and the normal of its surface.

#include "raytrace/light/optics.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Frame of a facet. The origin is the point of the facet's plane with the x and y coordinates of the facet's centroid.
/// x is horizontal and y points down the facet, both in its plane. x, y and the normal out of the part are
/// right-handed.
struct FacetFrame {
  Vec3 origin_mm = Vec3::Zero();
  Vec3 horizontal = Vec3::UnitX();
  Vec3 down = Vec3::UnitY();

  FacetFrame() = default;
  /// \param normal unit normal of the plane normal . p = offset_mm, which points out of the part
  /// \param centroid_mm see PatchFacet::centroid_mm
  FacetFrame(const Vec3& normal, double offset_mm, const Vec2& centroid_mm);

  Vec2 local(const Vec3& p) const { return {horizontal.dot(p - origin_mm), down.dot(p - origin_mm)}; }
};

/// Returns the normal of the facet's surface including its form. The normal points out of the part. It is evaluated at
/// the point where light meets the plane of the facet. The distance between the surface and the plane, a few um at
/// most, is neglected. At grazing incidence, a ray could leave on the wrong side of the plane. In this case, the normal
/// of the plane is returned.
/// \param normal normal of the plane
/// \param direction unit direction of the light before it meets the facet
/// \param inside true if the light comes from inside the part
Vec3 formed_normal(const Optics& optics, const Vec3& normal, const FacetFrame& frame, const Vec3& point,
                   const Vec3& direction, bool inside);

}  // namespace retrace::raytrace
