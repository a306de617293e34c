#pragma once

// Intersection of rays with an entrance surface given as triangles, with the same search as for the back of a part.

#include "geometry/entrance/entrance_mesh.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/entrance_face.h"

namespace retrace::raytrace {

/// An entrance surface of plane triangles. A BackSurface finds the first triangle that a ray meets.
class MeshEntrance : public EntranceFace {
 public:
  MeshEntrance(const geometry::SurfacePatch& patch, const geometry::Polygon& outline, const Vec2& centre_mm);

  std::optional<EntranceHit> first_hit(const SurfaceRay& ray) const override;

 private:
  /// Returns true if the ray passes through the whole range of heights of the surface before `t_max`, from the side on
  /// which it starts. It then meets the surface, except for gaps between triangles that are caused by rounding.
  bool crosses(const SurfaceRay& ray) const;

  geometry::Part part_;  ///< heights are relative to the lowest point of the surface
  BackSurface surface_;
};

}  // namespace retrace::raytrace
