#include "retrace/part.h"

#include "core/atomic_file.h"
#include "library/content.h"
#include "studies/solids/io/solid_files.h"
#include "studies/solids/solids.h"

namespace retrace {
namespace {

studies::Solid solid_of(const Design& design, const SolidRequest& request) {
  return studies::make_solid(design.content().design, {studies::read_solid_kind(request.what), request.block_mm});
}

FaceKind kind_of(geometry::FacetRole role) {
  switch (role) {
    case geometry::FacetRole::entrance: return FaceKind::entrance;
    case geometry::FacetRole::retro_facet: return FaceKind::retro_facet;
    case geometry::FacetRole::flat_back: return FaceKind::flat_back;
    case geometry::FacetRole::inner_wall: return FaceKind::inner_wall;
    case geometry::FacetRole::border_wall: return FaceKind::border_wall;
    case geometry::FacetRole::side: return FaceKind::side;
  }
  return FaceKind::side;
}

}  // namespace

Mesh mesh(const Design& design, const SolidRequest& request) {
  const studies::Solid solid = solid_of(design, request);
  Mesh mesh;
  for (const geometry::Vec3& vertex : solid.mesh.vertices)
    mesh.vertices_mm.push_back({vertex.x(), vertex.y(), vertex.z()});
  mesh.triangles = solid.mesh.triangles;
  for (const geometry::FacetRole role : solid.mesh.roles) mesh.kinds.push_back(kind_of(role));
  mesh.volume_mm3 = solid.volume_mm3;
  mesh.area_mm2 = solid.area_mm2;
  mesh.is_manifold = solid.is_manifold;
  mesh.warnings = solid.warnings;
  return mesh;
}

ExportResult export_solid(const Design& design, const std::filesystem::path& file, const SolidRequest& request) {
  const studies::SolidFormat format = studies::solid_format(file.string());
  const studies::Solid solid = solid_of(design, request);
  write_file_atomically(file, studies::solid_text(solid, format));
  return {solid.warnings, studies::solid_json(solid, file.string()), studies::solid_table(solid)};
}

}  // namespace retrace
