#pragma once

// Rays against an entrance surface given as triangles, by the same search as that of the back of a part.

#include "geometry/entrance/entrance_mesh.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/entrance_face.h"

namespace retrace::raytrace {

/// An entrance surface of plane triangles, searched as the back of a part is.
class MeshEntrance : public EntranceFace {
 public:
  MeshEntrance(const geometry::SurfacePatch& patch, const geometry::Polygon& outline, const Vec2& centre_mm);

  std::optional<EntranceHit> first_hit(const SurfaceRay& ray) const override;

 private:
  /// Whether the ray comes to the heights of the entrance surface from the side that it is on, and has time to cross
  /// them.
  bool crosses(const SurfaceRay& ray) const;

  geometry::Part part_;  ///< in heights above the lowest place
  BackSurface surface_;
};

}  // namespace retrace::raytrace
