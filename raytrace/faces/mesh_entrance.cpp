#include "raytrace/faces/mesh_entrance.h"

#include <cmath>

namespace retrace::raytrace {
namespace {

/// Returns a part whose back consists of the triangles, because BackSurface searches the back of a part.
geometry::Part part_of(const geometry::SurfacePatch& patch, const geometry::EntranceRange& range,
                       const geometry::Polygon& outline) {
  geometry::Part part;
  part.patches.push_back(patch);
  part.placements.push_back({0, Vec2::Zero(), -range.lowest_mm});
  part.outline = outline;
  part.element_depth_mm = range.highest_mm - range.lowest_mm;
  part.thickness_mm = part.element_depth_mm;
  part.size_mm = std::sqrt(geometry::area(outline) / static_cast<double>(patch.triangles.size()));
  return part;
}

}  // namespace

MeshEntrance::MeshEntrance(const geometry::SurfacePatch& patch, const geometry::Polygon& outline, const Vec2& centre_mm)
    : EntranceFace(geometry::range_of_entrance_mesh(patch, outline), centre_mm),
      part_(part_of(patch, {lowest_mm(), highest_mm(), {}, {}, 0.0}, outline)),
      surface_(part_, centre_mm) {}

bool MeshEntrance::crosses(const SurfaceRay& ray) const {
  const double dz = ray.direction.z();
  if (ray.inside ? dz <= 0.0 : dz >= 0.0) return false;
  const double far_mm = ray.inside ? highest_mm() : lowest_mm();
  return ray.t_max >= (far_mm - ray.origin.z()) / dz;
}

std::optional<EntranceHit> MeshEntrance::first_hit(const SurfaceRay& ray) const {
  SurfaceRay local = ray;
  local.origin.z() -= lowest_mm();
  // Due to rounding, a ray may pass between two triangles.
  const std::optional<SurfaceHit> hit =
      crosses(ray) ? surface_.first_hit_with_tolerance(local) : surface_.first_hit(local);
  if (!hit || hit->t > ray.t_max) return std::nullopt;
  return EntranceHit{*hit, surface_.facet(hit->facet).normal};
}

}  // namespace retrace::raytrace
