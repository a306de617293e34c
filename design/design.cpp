#include "design/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "core/overloaded.h"
#include "core/schema/reader.h"
#include "design/mesh_keys.h"
#include "geometry/io/substrate_rows.h"

namespace retrace::design {

namespace fs = std::filesystem;

std::vector<fs::path> Design::files() const {
  return document ? document->files() : std::vector<fs::path>();
}

namespace {

/// Returns a warning for each correlation length or waviness period whose rms height is missing in the document. An
/// explicit height of 0 causes no warning, because parameter studies vary heights starting from 0.
Warnings lengths_without_heights(const schema::Document& document) {
  Warnings warnings;
  for (const auto& [length, height] : {std::pair("surface.correlation_length_um", "surface.roughness_sq_nm"),
                                       {"surface.correlation_length_down_um", "surface.roughness_sq_nm"},
                                       {"surface.waviness_length_um", "surface.waviness_sq_nm"},
                                       {"entrance.correlation_length_um", "entrance.roughness_sq_nm"}})
    if (document.number_if(length).value_or(0.0) > 0.0 && document.has(length) && !document.has(height))
      warnings.push_back(
          {"key_without_effect",
           InputError(document.where(length),
                      fmt::format("has no effect without {}: give both keys, or remove this key", height))
               .what()});
  return warnings;
}

}  // namespace

Warnings Design::warnings() const {
  if (!document) return {};
  Warnings warnings = schema::renamed_keys(*document);
  append(warnings, schema::superseded_keys(*document));
  append(warnings, lengths_without_heights(*document));
  return warnings;
}

InputLocation Design::where(std::string_view key) const {
  return document ? document->where(key) : InputLocation{source, 0, std::string(key)};
}

InputLocation Design::where_texture() const {
  for (const std::string_view key : {"surface.height_map", "surface.model", "surface.roughness_sq_nm"})
    if (document && document->has(key)) return where(key);
  return where("surface.waviness_sq_nm");
}

InputLocation Design::where_form() const {
  for (const std::string_view key : {"form.map", "form.terms", "form.sink_um"})
    if (document && document->has(key)) return where(key);
  return where("form");
}

InputLocation Design::where_entrance_scatters() const {
  const EntranceState& face = surface.entrance;
  return where(face.drop_coverage > 0.0      ? "entrance.drop_coverage"
               : face.dust_coverage > 0.0    ? "entrance.dust_coverage"
               : face.scratch_coverage > 0.0 ? "entrance.scratch_coverage"
               : face.haze > 0.0             ? "entrance.haze"
                                             : "entrance.roughness_sq_nm");
}

bool Coating::has_opaque_facets() const {
  return std::ranges::any_of(facets, [](const CoatingLayer& layer) { return !layer.thickness_nm; });
}

bool Coating::has_only_aluminium_on_facets() const {
  return facets.size() == 1 && facets[0] == kPlainAluminium;
}

std::optional<GlassCatalogueFile> with_absolute_path(const std::optional<GlassCatalogueFile>& catalogue) {
  if (!catalogue) return std::nullopt;
  const fs::path file = fs::absolute(catalogue->file).lexically_normal();
  return GlassCatalogueFile{file.string(), file};
}

std::string CurvedEntrance::name() const {
  return file() != nullptr ? file()->name : std::string(geometry::kEntranceKinds[form()->shape.index()]);
}

namespace {

/// Returns the name of the key that determines the shape of an entrance face.
std::string_view shape_key_of(const EntranceForm& form) {
  return std::visit(Overloaded{[](const geometry::PlaneEntrance&) { return "entrance_surface.kind"; },
                               [](const geometry::BiconicEntrance&) { return "entrance_surface.radii_mm"; },
                               [](const geometry::FormulaEntrance&) { return "entrance_surface.formula"; },
                               [](const geometry::StepFace&) { return "entrance_surface.file"; },
                               [](const auto&) { return "entrance_surface.radius_mm"; }},
                    form.shape);
}

}  // namespace

OutlineKeys with_absolute_path(OutlineKeys outline) {
  if (outline.file.empty()) return outline;
  outline.file = fs::absolute(outline.file).lexically_normal();
  for (auto& [key, value] : outline.values)
    if (key == "dxf" || key == "file") value = outline.file.string();
  return outline;
}

std::string_view Design::entrance_key() const {
  if (entrance && entrance->form() != nullptr) return shape_key_of(*entrance->form());
  return entrance && entrance->is_mesh() ? "entrance_surface.mesh" : "entrance_surface.turned_part";
}

const geometry::EntranceInclination* Design::inclination() const {
  const EntranceForm* const form = entrance ? entrance->form() : nullptr;
  if (form == nullptr) return nullptr;
  const bool is_upright = form->inclination.incidence_deg == 0.0 && form->inclination.pin_angle_deg == 0.0;
  return is_upright ? nullptr : &form->inclination;
}

geometry::Vec3 Design::reference_axis() const {
  return inclination() != nullptr ? geometry::reference_axis_of(*inclination()) : geometry::Vec3::UnitZ();
}

double Design::incident_fraction(const geometry::Vec3& to_source) const {
  if (inclination() == nullptr) return to_source.z();
  const geometry::Vec3 axis = geometry::rotation_of(*inclination()).col(2);
  return std::max(0.0, axis.dot(to_source)) / axis.z();
}

bool Design::has_deflecting_shells() const {
  return std::ranges::any_of(shells, [](const OuterShell& shell) { return !shell.is_plane_parallel(); });
}

InputLocation Design::where_shell_deflects() const {
  const auto found = std::ranges::find_if(shells, [](const OuterShell& shell) { return !shell.is_plane_parallel(); });
  return where(schema::path_of_entry("shell", static_cast<std::size_t>(found - shells.begin())));
}

const ArrayMask* Design::mask() const {
  return elements() != nullptr && elements()->mask ? &*elements()->mask : nullptr;
}

const FacetPlanesFile* Design::facet_planes() const {
  return elements() != nullptr && elements()->facet_planes ? &*elements()->facet_planes : nullptr;
}

const CellSpread* Design::cell_spread() const {
  return elements() != nullptr && elements()->cell_spread ? &*elements()->cell_spread : nullptr;
}

double Design::thickness_mm() const {
  return std::visit(Overloaded{[](const ElementArray& array) { return array.part.thickness_mm; },
                               [](const PartMesh& mesh) { return mesh.thickness_mm.value_or(0.0); },
                               [](const Plate& plate) { return plate.thickness_mm; },
                               [](const ZonedPart& zoned) { return zoned.spec.thickness_mm; },
                               [](const raytrace::BallLayer&) { return 0.0; }},
                    shape);
}

void require_supported(const Design& design, const Capabilities& capabilities) {
  const std::string what(capabilities.what);
  const auto refuse_solid = [&](std::string_view key, std::string_view solid) {
    if (!capabilities.solids)
      throw InputError(
          design.where(key),
          fmt::format(
              "{} is not available for a {}, only for a part that is described by one [element] and one [array]", what,
              solid));
  };
  std::visit(Overloaded{[&](const ElementArray& array) {
                          if (array.part.substrate && !capabilities.substrates)
                            throw InputError(
                                design.where(geometry::substrate_shape_key(*array.part.substrate)),
                                what + " is not available for elements on a [substrate], only for elements on a plane");
                        },
                        [&](const PartMesh&) {
                          const MeshKeys keys = mesh_keys_of(design);
                          refuse_solid(mesh_file_key(design), keys.is_solid ? "solid of a file" : "mesh");
                        },
                        [&](const Plate&) { refuse_solid("part.plate_mm", "plate"); },
                        [&](const ZonedPart&) {
                          if (!capabilities.zones) refuse_solid("zone", "part with zones");
                        },
                        [&](const raytrace::BallLayer&) {
                          if (!capabilities.balls)
                            throw InputError(
                                design.where("element.kind"),
                                "balls are available only for the commands retrace rre, photometry and inspect");
                        }},
             design.shape);
  if (design.entrance && !capabilities.entrances)
    throw InputError(design.where(design.entrance_key()),
                     what + " is not available for a part with an [entrance_surface], only for a plane entrance face");
  if (!design.shells.empty() && !capabilities.shells)
    throw InputError(design.where(schema::path_of_entry("shell", 0)),
                     what + " is not available for a part behind a [[shell]]: remove the shells from the design");
  if (design.wet_back && !capabilities.wet_backs)
    throw InputError(
        design.where("wet_back.index"),
        what + " is not available for a part with a [wet_back], only for the same medium behind all elements");
  if (design.cell_spread() != nullptr && !capabilities.cell_spreads)
    throw InputError(design.where("array.depth_spread_nm"),
                     what + " adds the intensities of cells: remove depth_spread_nm and spacing_spread_nm");
}

}  // namespace retrace::design
