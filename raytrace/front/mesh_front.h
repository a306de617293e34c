#pragma once

#include "geometry/front_mesh.h"
#include "raytrace/back_surface.h"
#include "raytrace/front/front_face.h"

namespace retrace::raytrace {

/// A front of plane triangles: Embree names them, their planes in double precision say where.
class MeshFront : public FrontFace {
 public:
  MeshFront(const geometry::SurfacePatch& patch, const geometry::Polygon& outline, const Vec2& centre_mm);

  std::optional<FrontHit> first_hit(const SurfaceRay& ray) const override;

 private:
  /// Whether the ray comes to the heights of the front from the side that it is on, and has time to cross them.
  bool crosses(const SurfaceRay& ray) const;

  BackSurface surface_;  ///< in heights above the lowest place
};

}  // namespace retrace::raytrace
