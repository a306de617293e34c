#include "studies/inspect/io/inspect_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "design/io/design_json.h"
#include "studies/inspect/io/step_face_texts.h"

namespace retrace::studies {
namespace {

std::string total_reflection(const Inspection& i) {
  if (i.entrance) return "not computed: a curved entrance surface refracts light into many directions";
  if (i.design.has_deflecting_shells()) return "not computed: a shell changes the direction of light";
  if (i.substrate) return "not computed: elements on a substrate have different orientations";
  if (!i.design.needs_total_reflection()) return "not needed: the facets are metal or mirrors";
  if (i.coating.facets && i.coating.facets->stack.absorbs()) return "none: the layers on the facets absorb light";
  if (!i.tir_limit_deg) return "none at normal incidence";
  const bool is_rtp = std::holds_alternative<geometry::RtpElement>(i.design.part().element);
  return fmt::format("up to {} degrees {}", fixed_visible(*i.tir_limit_deg, 2),
                     is_rtp ? "across the roof edge" : "at every azimuth");
}

/// Returns the lines of the report about the refractive index. For a spectrum, they also contain the range of the
/// traced wavelengths and the indices at both ends of this range.
std::string light_text(const Inspection& i) {
  const std::string wavelength = i.design.light.spectrum() ? fixed(i.wavelength_nm, 1) : shortest(i.wavelength_nm);
  const std::optional<double>& temperature_c = i.design.substance.temperature_c;
  const std::string text =
      fmt::format("  refractive index    {} at {} nm{}\n", fixed(i.refractive_index, 5), wavelength,
                  temperature_c ? fmt::format(" and {} degrees C", shortest(*temperature_c)) : "");
  if (!i.design.light.spectrum()) return text;
  const design::SpectralOptics& first = i.light.front();
  const design::SpectralOptics& last = i.light.back();
  return text + fmt::format("  spectrum            {} wavelengths, {} to {} nm, index {} to {}\n", i.light.size(),
                            fixed(first.wavelength_nm, 1), fixed(last.wavelength_nm, 1), fixed(first.optics.index, 5),
                            fixed(last.optics.index, 5));
}

nlohmann::ordered_json substrate_json(const SubstrateReport& substrate) {
  const auto& [area_mm2, lowest_mm, highest_mm, steepest_deg, min_radius_mm] = substrate.measures;
  nlohmann::ordered_json json = {{"area_mm2", area_mm2},
                                 {"height_range_mm", highest_mm - lowest_mm},
                                 {"steepest_deg", steepest_deg},
                                 {"element_mm", substrate.element_mm},
                                 {"highest_step_mm", substrate.walls.highest_mm},
                                 {"pocket_walls_mm2", substrate.walls.area_mm2},
                                 {"pocket_projected_mm2", substrate.walls.projected_mm2}};
  if (std::isfinite(min_radius_mm)) json["min_radius_mm"] = min_radius_mm;
  return json;
}

nlohmann::ordered_json entrance_json(const EntranceReport& entrance) {
  return {{"lowest_mm", entrance.range.lowest_mm},
          {"highest_mm", entrance.range.highest_mm},
          {"steepest_deg", entrance.steepest_deg}};
}

nlohmann::ordered_json shells_json(const Inspection& i) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < i.shells->shells.size(); ++k) {
    const ShellReport& shell = i.shells->shells[k];
    json.push_back({{"refractive_index", shell.refractive_index},
                    {"transmittance", shell.transmittance},
                    {"min_thickness_mm", shell.clearance.min_thickness_mm},
                    {"max_thickness_mm", shell.clearance.max_thickness_mm},
                    {"min_gap_mm", shell.clearance.min_gap_mm},
                    {"deflects_light", !i.design.shells[k].is_plane_parallel()}});
  }
  return json;
}

/// Returns the lines of the report that describe the shells in front of the part.
std::string shells_text(const Inspection& i) {
  std::string text;
  if (!i.shells) return text;
  for (std::size_t k = 0; k < i.shells->shells.size(); ++k) {
    const ShellReport& shell = i.shells->shells[k];
    const design::OuterShell& given = i.design.shells[k];
    const std::string material = given.refractive_index ? std::string() : printable(given.material) + ", ";
    text += fmt::format("  {:<20}{}index {}, {} to {} mm thick along z, at least {} mm in front of the {}\n",
                        fmt::format("shell {}", k + 1), material, fixed(shell.refractive_index, 5),
                        fixed(shell.clearance.min_thickness_mm, 4), fixed(shell.clearance.max_thickness_mm, 4),
                        fixed(shell.clearance.min_gap_mm, 4), k + 1 < i.shells->shells.size() ? "next shell" : "part");
    text += fmt::format("  {:<20}transmits {} % in one crossing at its middle; {}\n", "",
                        fixed(100.0 * shell.transmittance, 3),
                        given.is_plane_parallel() ? "plane-parallel" : "changes the direction of light");
  }
  return text;
}

nlohmann::ordered_json form_json(const design::FormReport& form) {
  return {{"radius_mm", form.radius_mm}, {"lowest_um", form.lowest_um}, {"highest_um", form.highest_um},
          {"rms_um", form.rms_um},       {"tilt_mrad", form.tilt_mrad}, {"steepest_mrad", form.steepest_mrad}};
}

std::string form_text(const Inspection& i) {
  if (!i.form) return {};
  return fmt::format("  form of facets      {} to {} um from their planes, rms {} um, slopes up to {} mrad{}\n",
                     fixed(i.form->lowest_um, 4), fixed(i.form->highest_um, 4), fixed(i.form->rms_um, 4),
                     fixed(i.form->steepest_mrad, 3),
                     i.form->tilt_mrad > 1e-6 ? fmt::format(", tilted by {} mrad", fixed(i.form->tilt_mrad, 3)) : "");
}

/// Returns the lines of the report about the cells of a ruled array.
std::string ruled_text(const Inspection& i) {
  constexpr std::size_t kMaxLines = 12;
  if (!i.ruled) return {};
  std::string text = fmt::format("  ruled cells         {} {}\n", i.ruled->cells.size(),
                                 i.ruled->is_period ? "per period" : "around the origin; the grooves have no period");
  for (std::size_t k = 0; k < std::min(kMaxLines, i.ruled->cells.size()); ++k) {
    const RuledCellReport& cell = i.ruled->cells[k];
    const auto angles = [](const std::array<double, 3>& deg, int digits) {
      return fmt::format("{} {} {}", fixed(deg[0], digits), fixed(deg[1], digits), fixed(deg[2], digits));
    };
    std::string line = fmt::format("{} faces", cell.faces);
    if (cell.dihedral_deg) line += fmt::format(", dihedral angles {}", angles(*cell.dihedral_deg, 4));
    if (cell.cant_deg)
      line += fmt::format(", cant {} towards {}", fixed(*cell.cant_deg, 3), fixed(cell.cant_azimuth_deg, 1));
    if (cell.base_deg) line += fmt::format(", base {}", angles(*cell.base_deg, 3));
    text += fmt::format("  {:<20}{} degrees; effective aperture {} %, truncated {} %\n", fmt::format("cell {}", k + 1),
                        line, fixed(100.0 * cell.effective_aperture, 2), fixed(100.0 * cell.truncated_fraction, 2));
  }
  if (i.ruled->cells.size() > kMaxLines)
    text += fmt::format("  {:<20}{} more cells are in the JSON document\n", "", i.ruled->cells.size() - kMaxLines);
  return text;
}

nlohmann::ordered_json ruled_json(const RuledReport& report) {
  nlohmann::ordered_json cells = nlohmann::ordered_json::array();
  for (const RuledCellReport& cell : report.cells) {
    nlohmann::ordered_json json = {{"area_mm2", cell.area_mm2}, {"faces", cell.faces}};
    if (cell.dihedral_deg) json["dihedral_deg"] = *cell.dihedral_deg;
    if (cell.cant_deg) json["cant_deg"] = *cell.cant_deg;
    if (cell.cant_deg) json["cant_azimuth_deg"] = cell.cant_azimuth_deg;
    if (cell.base_deg) json["base_deg"] = *cell.base_deg;
    json["effective_aperture"] = cell.effective_aperture;
    json["truncated_fraction"] = cell.truncated_fraction;
    json["bottom_fraction"] = cell.bottom_fraction;
    cells.push_back(json);
  }
  return {{"is_period", report.is_period}, {"cells", cells}};
}

std::string entrance_text(const Inspection& i) {
  if (!i.entrance) return {};
  return fmt::format("  entrance surface    {}, z = {} to {} mm, slopes up to {} degrees\n",
                     printable(i.design.entrance->name()), fixed(i.entrance->range.lowest_mm, 6),
                     fixed(i.entrance->range.highest_mm, 6), fixed_visible(i.entrance->steepest_deg, 2));
}

nlohmann::ordered_json coating_json(const CoatingReport& face) {
  nlohmann::ordered_json layers = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < face.layers.size(); ++k) {
    nlohmann::ordered_json layer;
    if (!face.layers[k].material.empty()) layer["material"] = face.layers[k].material;
    layer["refractive_index"] = face.stack.layers[k].index.real();
    layer["extinction_coefficient"] = face.stack.layers[k].index.imag();
    if (face.layers[k].thickness_nm) layer["thickness_nm"] = *face.layers[k].thickness_nm;
    layers.push_back(layer);
  }
  return {{"layers", layers},
          {"reflectance", face.reflectance},
          {"transmittance", face.transmittance},
          {"absorptance", face.absorptance}};
}

void add_entrance_state(const Inspection& i, nlohmann::ordered_json& json) {
  if (!i.entrance_state) return;
  const auto& [clean_fraction, reflectance, transmittance, absorptance, specular, haze_fraction, dust] =
      *i.entrance_state;
  json["entrance"] = {{"clean_fraction", clean_fraction},
                      {"reflectance", reflectance},
                      {"transmittance", transmittance},
                      {"absorptance", absorptance},
                      {"specular_transmittance", specular}};
  if (haze_fraction > 0.0) json["entrance"]["haze_fraction"] = haze_fraction;
  if (i.design.surface.entrance.dust_coverage > 0.0) json["entrance"]["dust_cd_per_lx_m2"] = dust;
}

void add_coating(const Inspection& i, nlohmann::ordered_json& json) {
  if (i.coating.facets) json["coating"]["facets"] = coating_json(*i.coating.facets);
  if (i.coating.entrance) json["coating"]["entrance"] = coating_json(*i.coating.entrance);
}

std::string layer_text(const design::CoatingLayer& layer) {
  std::string name = printable(layer.material);
  if (name.empty()) name = "n = " + shortest(layer.refractive_index);
  if (layer.extinction_coefficient > 0.0) name += fmt::format(" + {} i", shortest(layer.extinction_coefficient));
  return layer.thickness_nm ? fmt::format("{} {} nm", name, shortest(*layer.thickness_nm)) : name + ", opaque";
}

/// Returns the lines of the report about the coating of a face, or an empty text if it has no coating.
/// \param label text of at most 20 characters
std::string coating_text(std::string_view label, const std::optional<CoatingReport>& face) {
  if (!face) return {};
  std::vector<std::string> layers;
  for (const design::CoatingLayer& layer : face->layers) layers.push_back(layer_text(layer));
  return fmt::format("  {:<20}{}, from the body outwards\n", label, fmt::join(layers, "; ")) +
         fmt::format("  {:<20}reflects {} %, transmits {} %, absorbs {} % at normal incidence\n", "",
                     fixed(100.0 * face->reflectance, 3), fixed(100.0 * face->transmittance, 3),
                     fixed(100.0 * face->absorptance, 3));
}

/// Returns the lines of the report about the contamination and damage of the entrance face.
std::string entrance_state_text(const Inspection& i) {
  if (!i.entrance_state) return {};
  const EntranceStateReport& face = *i.entrance_state;
  std::string text = fmt::format(
      "  {:<20}{} % free of drops, dust and scratches; this area reflects {} %, transmits {} %, absorbs {} % at normal "
      "incidence\n",
      "entrance state", fixed(100.0 * face.clean_fraction, 3), fixed(100.0 * face.reflectance, 3),
      fixed(100.0 * face.transmittance, 3), fixed(100.0 * face.absorptance, 3));
  text += fmt::format("  {:<20}transmits {} % of all light without scattering\n", "",
                      fixed(100.0 * face.specular_transmittance, 3));
  if (face.haze_fraction > 0.0)
    text += fmt::format("  {:<20}haze scatters {} % of the light in one passage\n", "",
                        fixed(100.0 * face.haze_fraction, 3));
  if (i.design.surface.entrance.dust_coverage > 0.0)
    text += fmt::format("  {:<20}dust returns {} cd/(lx m2) along the normal\n", "", fixed(face.dust_cd_per_lx_m2, 6));
  return text;
}

/// Returns the lines of the report about the coatings of the faces and the state of the entrance face.
std::string coatings_text(const Inspection& i) {
  return coating_text("facets", i.coating.facets) + coating_text("entrance face", i.coating.entrance) +
         entrance_state_text(i);
}

std::string place_text(const geometry::ElementChoice& choice) {
  return std::visit(
      Overloaded{[](const geometry::RandomFraction& random) {
                   return fmt::format("each with a probability of {}, seed {}", shortest(random.fraction), random.seed);
                 },
                 [](const geometry::Rectangle& r) {
                   return fmt::format("x {} to {}, y {} to {} mm", shortest(r.lower.x()), shortest(r.upper.x()),
                                      shortest(r.lower.y()), shortest(r.upper.y()));
                 },
                 [](const geometry::Disc& disc) {
                   return fmt::format("within {} mm of x {}, y {} mm", shortest(disc.radius_mm),
                                      shortest(disc.centre_mm.x()), shortest(disc.centre_mm.y()));
                 },
                 [](const geometry::HalfPlane& half) {
                   return fmt::format("beyond x {}, y {} mm towards azimuth {}", shortest(half.through_mm.x()),
                                      shortest(half.through_mm.y()), shortest(half.azimuth_deg));
                 }},
      choice);
}

/// Returns the lines of the report about elements that have another medium behind their facets.
std::string wet_back_text(const Inspection& i) {
  if (!i.wet_back) return {};
  return fmt::format("  wet back            {} of {} elements, index {} behind their facets: {}\n",
                     i.wet_back->elements, i.wet_back->of_all, shortest(i.design.wet_back->index),
                     place_text(i.design.wet_back->where)) +
         fmt::format("                      total reflection in wet elements: {}\n",
                     i.wet_back->tir_limit_deg
                         ? fmt::format("up to {} degrees", fixed_visible(*i.wet_back->tir_limit_deg, 2))
                         : "at no angle, or not computed");
}

nlohmann::ordered_json wet_back_json(const Inspection& i) {
  nlohmann::ordered_json json = {{"elements", i.wet_back->elements},
                                 {"of_all", i.wet_back->of_all},
                                 {"refractive_index", i.design.wet_back->index}};
  if (i.wet_back->tir_limit_deg) json["tir_limit_deg"] = *i.wet_back->tir_limit_deg;
  return json;
}

/// Returns the name of faces with a role in documents.
std::string_view face_name(geometry::FacetRole role) {
  switch (role) {
    case geometry::FacetRole::entrance: return "entrance";
    case geometry::FacetRole::retro_facet: return "retro_facet";
    case geometry::FacetRole::flat_back: return "flat_back";
    case geometry::FacetRole::inner_wall: return "inner_wall";
    case geometry::FacetRole::border_wall: return "border_wall";
    case geometry::FacetRole::side: break;
  }
  return "side";
}

nlohmann::ordered_json position_json(const geometry::Vec3& p) {
  return nlohmann::ordered_json::array({p.x(), p.y(), p.z()});
}

/// Smallest, mean and largest angle between the axes of the elements and the normal of the entrance face.
struct PinAngles {
  double min_deg = 180.0;
  double mean_deg = 0.0;
  double max_deg = 0.0;
};

PinAngles pin_angles(const ToolReport& tool) {
  PinAngles angles;
  for (const PinAxis& pin : tool.pin_axes) {
    angles.min_deg = std::min(angles.min_deg, pin.angle_deg());
    angles.max_deg = std::max(angles.max_deg, pin.angle_deg());
    angles.mean_deg += pin.angle_deg() / static_cast<double>(tool.pin_axes.size());
  }
  return angles;
}

nlohmann::ordered_json tool_json(const ToolReport& tool) {
  nlohmann::ordered_json draft = nlohmann::ordered_json::array();
  for (const DraftOfFaces& of : tool.draft)
    draft.push_back({{"faces_of", face_name(of.role)},
                     {"faces", of.faces},
                     {"area_mm2", of.area_mm2},
                     {"min_draft_deg", of.min_draft_deg},
                     {"below_limit", of.below_limit},
                     {"undercuts", of.undercuts},
                     {"undercut_mm2", of.undercut_mm2}});
  nlohmann::ordered_json json = {{"min_wall_mm", tool.wall.thickness_mm},
                                 {"min_wall_back_mm", position_json(tool.wall.back_mm)},
                                 {"min_wall_entrance_mm", position_json(tool.wall.entrance_mm)},
                                 {"demoulding", position_json(tool.demoulding)},
                                 {"min_draft_deg", tool.min_draft_deg()},
                                 {"below_limit", tool.below_limit()},
                                 {"undercuts", tool.undercuts()},
                                 {"draft", draft},
                                 {"optical_area_fraction", tool.optical_area_fraction}};
  if (!tool.pin_axes.empty()) {
    const PinAngles angles = pin_angles(tool);
    json["pin_axes"] = {{"pins", tool.pin_axes.size()},
                        {"min_deg", angles.min_deg},
                        {"mean_deg", angles.mean_deg},
                        {"max_deg", angles.max_deg}};
  }
  return json;
}

/// Returns the lines of the report for the toolmaker.
std::string tool_text(const Inspection& i) {
  if (!i.tool) return {};
  const ToolReport& tool = *i.tool;
  const auto steepest = std::ranges::min_element(tool.draft, {}, &DraftOfFaces::min_draft_deg);
  std::string text = fmt::format("  smallest wall       {} mm at x = {}, y = {} mm\n", fixed(tool.wall.thickness_mm, 6),
                                 fixed(tool.wall.back_mm.x(), 4), fixed(tool.wall.back_mm.y(), 4));
  text +=
      fmt::format("  smallest draft      {} degrees ({}); {} faces below the limit, {} undercuts\n",
                  fixed(steepest->min_draft_deg, 3), face_name(steepest->role), tool.below_limit(), tool.undercuts());
  text += fmt::format("  optical area        {} % of the plan\n", fixed(100.0 * tool.optical_area_fraction, 3));
  if (!tool.pin_axes.empty()) {
    const PinAngles angles = pin_angles(tool);
    text += fmt::format("  element axes        {} to {} degrees from the normal of the entrance surface\n",
                        fixed(angles.min_deg, 3), fixed(angles.max_deg, 3));
  }
  return text;
}

std::string substrate_text(const Inspection& i) {
  if (!i.substrate) return {};
  const auto& [area_mm2, lowest_mm, highest_mm, steepest_deg, min_radius_mm] = i.substrate->measures;
  const std::string radius = std::isfinite(min_radius_mm) ? fixed(min_radius_mm, 4) + " mm" : "plane";
  return fmt::format("  substrate           {} mm2, {} mm high, slopes up to {} degrees\n", fixed(area_mm2, 4),
                     fixed(highest_mm - lowest_mm, 4), fixed_visible(steepest_deg, 2)) +
         fmt::format("  minimum radius      {}; an element is {} mm wide\n", radius,
                     fixed(i.substrate->element_mm, 4)) +
         fmt::format(
             "  between elements    steps up to {} mm; area of the walls {} mm2, projected along the normal of the "
             "substrate {} mm2\n",
             fixed(i.substrate->walls.highest_mm, 6), fixed(i.substrate->walls.area_mm2, 4),
             fixed(i.substrate->walls.projected_mm2, 4));
}

}  // namespace

namespace {

/// Returns the keys that the documents of all kinds of designs have in common.
nlohmann::ordered_json common_json(const Inspection& i) {
  return {{"design", design::to_json(i.design)},
          {"elements_full", i.elements_full},
          {"elements_partial", i.elements_partial},
          {"element_depth_mm", i.element_depth_mm},
          {"facet_area_mm2", i.facet_area_mm2},
          {"entrance_area_mm2", i.entrance_area_mm2},
          {"full_element_area_fraction", i.full_element_area_fraction},
          {"refractive_index", i.refractive_index}};
}

std::string ball_json(const Inspection& i) {
  const BallFigures& balls = *i.balls;
  nlohmann::ordered_json json = common_json(i);
  json["packing_fraction"] = balls.packing_fraction;
  json["mirror_half_angle_deg"] = balls.mirror_half_angle_deg;
  json["paraxial_error"] = balls.paraxial_error;
  json["largest_return_error_deg"] = balls.largest_return_error_deg;
  json["fraction_within_acceptance"] = balls.fraction_within_acceptance;
  if (balls.focal_offset_mm) json["focal_offset_mm"] = *balls.focal_offset_mm;
  if (i.design.light.spectrum()) json["spectrum"] = design::spectrum_json(i.light);
  add_coating(i, json);
  return result_text("retrace.inspect/2", json, i.warnings);
}

/// Returns the lines of the report about the zones of a part: their sizes, their elements, and the distance that light
/// travels across zones.
std::string zones_text(const Inspection& i) {
  std::string text;
  if (!i.zones) return text;
  for (std::size_t k = 0; k < i.zones->zones.size(); ++k) {
    const ZoneReport& zone = i.zones->zones[k];
    std::string changes;
    for (const design::ZoneChange& change : i.design.zoned()->changes[k]) changes += "; " + change.text;
    const double turn_deg = i.design.zoned()->spec.zones[k].rotation_deg;
    std::string shift;
    if (zone.lateral_shift_mm)
      shift = fmt::format(", mean lateral shift of the light {} mm", fixed(*zone.lateral_shift_mm, 4));
    text += fmt::format(
        "  {:<20}{} %, {} full elements, {} cut{}{}{}\n", fmt::format("zone {}", k + 1),
        fixed(100.0 * zone.elements.area_mm2 / i.entrance_area_mm2, 3), zone.elements.full, zone.elements.partial,
        shift, turn_deg != 0.0 ? fmt::format("; rotated by {} degrees", shortest(turn_deg)) : "", printable(changes));
  }
  for (const ZoneCrossing& crossing : i.zones->crossings)
    text += fmt::format("  {:<20}{} % of the light that is returned at {} degrees of incidence crosses two zones\n", "",
                        fixed(100.0 * crossing.fraction, 2), shortest(crossing.incidence_deg));
  return text;
}

nlohmann::ordered_json zones_json(const ZonesReport& report) {
  nlohmann::ordered_json json = {{"zones", nlohmann::ordered_json::array()},
                                 {"meets_two_zones", nlohmann::ordered_json::array()}};
  for (const ZoneReport& zone : report.zones) {
    json["zones"].push_back({{"area_mm2", zone.elements.area_mm2},
                             {"elements_full", zone.elements.full},
                             {"elements_partial", zone.elements.partial}});
    if (zone.lateral_shift_mm) json["zones"].back()["lateral_shift_mm"] = *zone.lateral_shift_mm;
  }
  for (const ZoneCrossing& crossing : report.crossings)
    json["meets_two_zones"].push_back({{"incidence_deg", crossing.incidence_deg}, {"fraction", crossing.fraction}});
  return json;
}

}  // namespace

std::string inspect_json(const Inspection& i) {
  if (i.balls) return ball_json(i);
  nlohmann::ordered_json json = common_json(i);
  if (i.zones) json.update(zones_json(*i.zones));
  if (i.design.zoned()) {
    json.erase("full_element_area_fraction");
  } else if (!i.design.elements()) {
    // The number of elements in a mesh is not known.
    for (const char* key : {"elements_full", "elements_partial", "full_element_area_fraction"}) json.erase(key);
  }
  if (!i.design.elements()) json["thickness_mm"] = i.thickness_mm;
  if (i.design.light.spectrum()) json["spectrum"] = design::spectrum_json(i.light);
  add_coating(i, json);
  add_entrance_state(i, json);
  if (i.tir_limit_deg) json["tir_limit_deg"] = *i.tir_limit_deg;
  if (i.tir_limit_azimuth_deg) json["tir_limit_azimuth_deg"] = *i.tir_limit_azimuth_deg;
  if (i.design.elements()) json["dead_zone_fraction"] = i.dead_zone_fraction;
  if (i.ruled) json["ruled"] = ruled_json(*i.ruled);
  if (i.substrate) json["substrate"] = substrate_json(*i.substrate);
  if (i.wet_back) json["wet_back"] = wet_back_json(i);
  if (i.entrance) json["entrance_surface"] = entrance_json(*i.entrance);
  add_step_faces(i.design, json);
  if (i.shells) json["shells"] = shells_json(i);
  if (i.form) json["form"] = form_json(*i.form);
  if (i.tool) json["tool"] = tool_json(*i.tool);
  json["boundary"] = i.boundary;
  return result_text("retrace.inspect/2", json, i.warnings);
}

namespace {

std::string mesh_text(const Inspection& i) {
  std::string text = fmt::format("{}\n", printable(design::short_name(i.design)));
  text += zones_text(i);
  text += fmt::format("  depth               {} mm\n", fixed(i.element_depth_mm, 6));
  text += fmt::format("  plate               {} mm\n", fixed(i.thickness_mm, 6));
  text += entrance_text(i);
  text += step_faces_text(i.design);
  text += shells_text(i);
  text += fmt::format("  entrance area       {} mm2\n", fixed(i.entrance_area_mm2, 4));
  text += fmt::format("  retro facet area    {} mm2\n", fixed(i.facet_area_mm2, 4));
  text += light_text(i);
  text += coatings_text(i);
  text += tool_text(i);
  text += fmt::format("  boundary            {}\n", i.boundary);
  return text;
}

std::string ball_text(const Inspection& i) {
  const BallFigures& balls = *i.balls;
  std::string text = fmt::format("{}\n", printable(design::short_name(i.design)));
  text += fmt::format("  packing             {} % of the plan area\n", fixed(100.0 * balls.packing_fraction, 3));
  text += fmt::format("  mirror              {} mm behind the balls, up to {} degrees from their axes\n",
                      shortest(i.design.balls()->mirror_offset_mm), fixed_visible(balls.mirror_half_angle_deg, 2));
  text += fmt::format("  offset for focus    {}\n",
                      balls.focal_offset_mm ? fixed(*balls.focal_offset_mm, 6) + " mm" : "none");
  text += light_text(i);
  text += coatings_text(i);
  text += fmt::format("  paraxial error      {} rad per unit of height / radius\n", fixed(balls.paraxial_error, 6));
  text += fmt::format("  max. return error   {} degrees\n", fixed_visible(balls.largest_return_error_deg, 3));
  text += fmt::format("  within acceptance   {} % of a ball's aperture\n",
                      fixed(100.0 * balls.fraction_within_acceptance, 3));
  return text;
}

}  // namespace

std::string inspect_text(const Inspection& i) {
  if (i.balls) return ball_text(i);
  if (!i.design.elements()) return mesh_text(i);
  const bool infinite = i.design.part().array.extent == geometry::Extent::infinite;
  const char* per_period = infinite ? " per period" : "";
  std::string text = fmt::format("{}\n", printable(design::short_name(i.design)));
  text += fmt::format("  elements            {} full, {} partial{}\n", i.elements_full, i.elements_partial, per_period);
  text += fmt::format("  element depth       {} mm\n", fixed(i.element_depth_mm, 6));
  text += fmt::format("  entrance area       {} mm2{}\n", fixed(i.entrance_area_mm2, 4), per_period);
  text += fmt::format("  full elements       {} % of the area\n", fixed(100.0 * i.full_element_area_fraction, 3));
  text += fmt::format("  retro facet area    {} mm2{}\n", fixed(i.facet_area_mm2, 4), per_period);
  text += ruled_text(i);
  text += substrate_text(i);
  text += entrance_text(i);
  text += step_faces_text(i.design);
  text += shells_text(i);
  text += form_text(i);
  text += light_text(i);
  text += coatings_text(i);
  text += fmt::format("  total reflection    {}\n", total_reflection(i));
  text += wet_back_text(i);
  text += fmt::format("  dead zone           {} %\n", fixed(100.0 * i.dead_zone_fraction, 3));
  text += tool_text(i);
  text += fmt::format("  boundary            {}\n", i.boundary);
  return text;
}

std::string pin_axes_csv(const Inspection& i) {
  if (!i.tool || i.tool->pin_axes.empty()) return {};
  CsvWriter csv("x_mm,y_mm,angle_deg,azimuth_deg,axis_x,axis_y,axis_z,normal_x,normal_y,normal_z");
  for (const PinAxis& pin : i.tool->pin_axes)
    csv.row(pin.centre_mm.x(), pin.centre_mm.y(), pin.angle_deg(), pin.azimuth_deg(), pin.axis.x(), pin.axis.y(),
            pin.axis.z(), pin.normal.x(), pin.normal.y(), pin.normal.z());
  return csv.text();
}

std::string draft_csv(const Inspection& i) {
  if (!i.tool || i.tool->steep_faces.empty()) return {};
  CsvWriter csv("faces_of,draft_deg,area_mm2,x_mm,y_mm,z_mm");
  for (const SteepFace& face : i.tool->steep_faces)
    csv.row(face_name(face.role), face.draft_deg, face.area_mm2, face.centroid_mm.x(), face.centroid_mm.y(),
            face.centroid_mm.z());
  return csv.text();
}

}  // namespace retrace::studies
