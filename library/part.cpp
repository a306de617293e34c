#include "retrace/part.h"

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/threads.h"
#include "library/content.h"
#include "studies/appearance/io/appearance_files.h"
#include "studies/solids/io/solid_files.h"
#include "studies/solids/solids.h"

namespace retrace {
namespace {

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
  const studies::Solid solid = studies::make_solid(design.content().design, request);
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
  const studies::Solid solid = studies::make_solid(design.content().design, request, studies::solid_entrance(format));
  write_file_atomically(file, studies::solid_text(solid, format));
  return {solid.warnings, studies::solid_json(solid, file.string()), studies::solid_table(solid)};
}

MaterialResult export_material(const Design& design, const std::filesystem::path& file, const MaterialRequest& request,
                               const Running& running) {
  const auto format = studies::appearance_format(file.string());
  if (!format) throw InputError({"", 0, "file"}, "must end in .json, .xml or .glsl, got " + in_quotes(file.string()));
  studies::AppearanceResult found;
  run_with_threads(running.threads, [&] {
    found = studies::compute_appearance(design.content().design, request, running.progress, running.cancellation);
  });
  MaterialResult result;
  result.complete = found.complete;
  if (!found.complete) return result;
  const std::filesystem::path values = std::filesystem::path(file).replace_extension(".csv");
  const studies::AppearanceText text = studies::appearance_text(found, *format, values.filename().string());
  if (format == studies::AppearanceFormat::table) write_file_atomically(values, text.values);
  write_file_atomically(file, text.text);
  result.warnings = found.warnings;
  result.json = studies::appearance_json(found, text, file.string());
  result.table = studies::appearance_table(found, text);
  return result;
}

}  // namespace retrace
