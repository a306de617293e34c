#include "design/io/part_reader.h"

#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "core/schema/reader.h"
#include "design/io/groove_reader.h"
#include "design/io/outline_reader.h"
#include "geometry/elements/element_cells.h"
#include "geometry/io/element_keys.h"
#include "geometry/io/substrate_rows.h"

namespace retrace::design {
namespace {

using geometry::Arrangement, geometry::PartSpec, schema::Document;

geometry::RoundCube round_cube_of(const Document& document, const geometry::Cant& cant) {
  geometry::RoundCube cube;
  cube.diameter_mm = document.number("element.diameter_mm");
  cube.cant = cant;
  cube.chamfer_mm = document.number("element.chamfer_mm");
  cube.recess_mm = document.number("element.recess_mm");
  cube.mount_diameter_mm =
      document.number_if("element.mount_diameter_mm").value_or(cube.recess_mm > 0.0 ? cube.diameter_mm : 0.0);
  if (has_outline(document)) cube.outline = std::make_shared<const geometry::PlanRegion>(read_outline(document));
  return cube;
}

geometry::Element element_of(const Document& document) {
  const std::string kind = document.text("element.kind");
  if (kind == "rtp")
    return geometry::RtpElement{document.number("element.base_mm"), document.number("element.width_mm"),
                                document.number("element.apex_angle_deg")};
  if (kind == "ruled") return read_grooves(document);
  const geometry::Cant cant{document.number("element.cant_deg"), document.number("element.cant_azimuth_deg")};
  if (kind == "round_icc") return round_cube_of(document, cant);
  const double aperture_mm = document.number("element.aperture_mm");
  if (kind == "hexagonal_icc") return geometry::HexagonalCube{aperture_mm, cant};
  return geometry::TriangularCube{aperture_mm, cant};
}

Arrangement arrangement_of(const std::string& word) {
  if (word == "pins") return Arrangement::honeycomb;
  const auto& words = geometry::kArrangementWords;
  return static_cast<Arrangement>(std::ranges::find(words, word) - std::begin(words));
}

void read_angle_errors(const Document& document, PartSpec& part) {
  auto& [dihedral, tilt] = part.angle_errors;
  const bool is_arcsec = document.has(kDihedralErrorArcsec);
  std::vector<double> errors = document.numbers(is_arcsec ? kDihedralErrorArcsec : kDihedralErrorArcmin);
  if (is_arcsec)
    for (double& error : errors) error /= 60.0;
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(part.element);
  for (std::size_t k = 0; k < (is_prism ? 1 : 3); ++k) dihedral[k] = errors[std::min(k, errors.size() - 1)];
  const std::vector<double> tilts = document.numbers("surface.facet_tilt_arcmin");
  std::copy_n(tilts.begin(), std::min(tilts.size(), tilt.size()), tilt.begin());
  part.random_tilts = {document.number("surface.angle_error_sigma_arcmin"),
                       static_cast<std::uint32_t>(document.number("surface.angle_error_seed"))};
}

void read_edges(const Document& document, geometry::EdgeShape& edges) {
  const auto mm = [&](std::string_view key) { return 1e-3 * document.number(key); };
  edges.root_radius_mm = mm("surface.root_radius_um");
  edges.root_chamfer_mm = mm("surface.root_chamfer_um");
  edges.rim_radius_mm = mm("surface.rim_radius_um");
  edges.rim_chamfer_mm = mm("surface.rim_chamfer_um");
  edges.chords = static_cast<int>(document.number("surface.edge_chords"));
}

geometry::Scratch scratch_of(const Document& document, const std::string& entry) {
  const auto mm = [&](std::string_view key) { return 1e-3 * document.number(schema::path_in(entry, key)); };
  geometry::Scratch scratch;
  scratch.facet = document.index(entry + ".facet");
  scratch.width_mm = mm("width_um");
  scratch.position_mm = mm("position_um");
  scratch.depth_mm = mm("depth_um");
  return scratch;
}

/// Returns the thickness of a round cube corner above z = 0, the height of the highest facet points. If the design
/// gives no length, the plate has its minimum thickness.
double plate_of_round_cube_mm(const Document& document, const PartSpec& part) {
  const double depth_mm = geometry::element_depth_mm(part.element, part.angle_errors);
  if (const auto length_mm = document.number_if("element.length_mm")) return *length_mm - depth_mm;
  if (const auto edge_mm = document.number_if("element.edge_length_mm"))
    return *edge_mm / std::numbers::sqrt3 - depth_mm;
  return min_thickness_mm(part);
}

/// Sets the outline of an array, and sets the size of the array to the bounding box of the outline.
void read_outline_into(const Document& document, geometry::ArrayLayout& array) {
  const auto outline = std::make_shared<const geometry::PlanRegion>(read_outline(document));
  array.x_length_mm = outline->box_mm.size().x();
  array.y_length_mm = outline->box_mm.size().y();
  array.x_offset_mm = array.y_offset_mm = outline->margin_mm;
  array.outline = outline;
}

}  // namespace

bool has_elements(const Document& document) {
  return !document.has("part.mesh") && !document.has("part.solid") && !document.has("part.plate_mm") &&
         document.text("element.kind") != "ball";
}

double min_thickness_mm(const PartSpec& part) {
  constexpr double kMinPlateMm = 1e-6;
  const double top_mm = geometry::element_top_mm(part.element, part.angle_errors);
  const bool is_round = std::holds_alternative<geometry::RoundCube>(part.element);
  return is_round || top_mm > 0.0 ? top_mm + kMinPlateMm : 0.0;
}

PartSpec read_array(const Document& document) {
  PartSpec part;
  part.element = element_of(document);
  const std::string arrangement = document.text("array.arrangement");
  part.array.arrangement = arrangement_of(arrangement);
  part.is_pin_bundle = arrangement == "pins";
  part.array.extent =
      document.text("array.extent") == "infinite" ? geometry::Extent::infinite : geometry::Extent::finite;
  const auto read = [&](std::string_view key, double& value) { value = document.number_if(key).value_or(value); };
  read("array.x_length_mm", part.array.x_length_mm);
  read("array.y_length_mm", part.array.y_length_mm);
  read("array.x_offset_mm", part.array.x_offset_mm);
  read("array.y_offset_mm", part.array.y_offset_mm);
  read("array.x_gap_mm", part.array.x_gap_mm);
  read("array.y_gap_mm", part.array.y_gap_mm);
  if (has_outline(document) && !std::holds_alternative<geometry::RoundCube>(part.element))
    read_outline_into(document, part.array);
  part.array.partial_elements = document.choice<geometry::PartialElements>("array.partial_elements");
  if (part.array.arrangement != Arrangement::offset) return part;
  part.array.shifted_rows = document.choice<geometry::RowParity>("array.shifted_rows");
  part.array.overlap_percent = document.number("array.overlap_percent");
  return part;
}

PartSpec read_part(const Document& document) {
  PartSpec part = read_array(document);
  if (document.has("substrate"))
    schema::fill(document, {.name = "substrate", .meaning = {}, .rows = geometry::design_substrate_rows()}, "substrate",
                 &part.substrate.emplace());
  if (part.substrate)
    if (auto* const face = std::get_if<geometry::StepFace>(&part.substrate->shape))
      face->choice.file = document.file("substrate.file");
  read_angle_errors(document, part);
  read_edges(document, part.edges);
  for (std::size_t i = 0; i < document.count("surface.scratches"); ++i)
    part.scratches.push_back(scratch_of(document, schema::path_of_entry("surface.scratches", i)));
  // A part whose elements follow its entrance surface has no key thickness_mm. The thickness of the wall is used until
  // find_offset() determines the thickness of the part.
  part.thickness_mm =
      document.number_if("body.thickness_mm").value_or(document.number_if("substrate.wall_mm").value_or(0.0));
  if (std::holds_alternative<geometry::RoundCube>(part.element))
    part.thickness_mm = plate_of_round_cube_mm(document, part);
  return part;
}

raytrace::BallLayer read_balls(const Document& document) {
  raytrace::BallLayer balls;
  balls.diameter_mm = document.number("element.diameter_mm");
  if (document.text("array.arrangement") == "packed")
    balls.pitch_mm = balls.diameter_mm + document.number("array.gap_mm");
  balls.mirror_offset_mm = document.number_if("element.mirror_offset_mm").value_or(0.0);
  const double most_deg = balls.max_mirror_half_angle_deg();
  balls.mirror_half_angle_deg =
      std::min(document.number_if("element.mirror_half_angle_deg").value_or(most_deg), most_deg);
  return balls;
}

}  // namespace retrace::design
