#pragma once

// Facets with a form: where light meets them in their own frame, and how the surface is turned there.

#include "raytrace/light/optics.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// The frame of a facet: its origin over the facet's middle; x level, y down the facet, both in its plane, so that x, y
/// and the normal out of the part are right-handed.
struct FacetFrame {
  Vec3 origin_mm = Vec3::Zero();
  Vec3 level = Vec3::UnitX();
  Vec3 down = Vec3::UnitY();

  FacetFrame() = default;
  /// \param normal of the plane normal . p = offset_mm, unit, out of the part \param middle_mm PatchFacet::middle_mm
  FacetFrame(const Vec3& normal, double offset_mm, const Vec2& middle_mm);

  Vec2 local(const Vec3& p) const { return {level.dot(p - origin_mm), down.dot(p - origin_mm)}; }
};

/// The normal of the formed surface, out of the part, at the place of its plane where light meets it. That the surface
/// lies beside the plane there, by less than some um, moves no ray. Where light grazes the facet, so that a ray from
/// there would lie on the wrong side of the plane, it is the plane's normal: the ledger knows planes.
/// \param normal of the plane \param direction of the light before it, unit \param inside it comes from the body
Vec3 formed_normal(const Optics& optics, const Vec3& normal, const FacetFrame& frame, const Vec3& point,
                   const Vec3& direction, bool inside);

}  // namespace retrace::raytrace
