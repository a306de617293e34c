#include "geometry/part/plate.h"

#include "geometry/part/mesh_part.h"

namespace retrace::geometry {

TriangleMesh box_mesh(const Vec2& size_mm, double thickness_mm) {
  TriangleMesh mesh;
  for (const double z : {0.0, thickness_mm})
    for (const Vec2& corner : to_polygon({Vec2::Zero(), size_mm}))
      mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t next = (k + 1) % 4;
    mesh.triangles.push_back({k, next, next + 4});
    mesh.triangles.push_back({k, next + 4, k + 4});
  }
  return mesh;
}

Part build_plate(const Vec2& size_mm, double thickness_mm) {
  Part part = part_of_mesh(box_mesh(size_mm, thickness_mm));
  for (PatchFacet& facet : part.patches[0].facets) facet.role = FacetRole::retro_facet;
  part.retro_facet_area_mm2 = part.entrance_area_mm2;
  return part;
}

}  // namespace retrace::geometry
