#include "design/io/design_document.h"

#include <algorithm>

#include "core/length_units.h"
#include "core/overloaded.h"
#include "core/schema/writer.h"
#include "design/file_names.h"
#include "design/io/design_format.h"
#include "design/io/groove_reader.h"
#include "design/mesh_keys.h"
#include "geometry/elements/element_cells.h"
#include "geometry/io/element_keys.h"
#include "geometry/outline/plan_region.h"

namespace retrace::design {
namespace {

using geometry::Arrangement, geometry::Cant, geometry::CylinderSubstrate, geometry::EdgeShape, geometry::Element,
    geometry::ElementAxes, geometry::Extent, geometry::FormulaSubstrate, geometry::HexagonalCube, geometry::PartSpec,
    geometry::PlaneSubstrate, geometry::RoundCube, geometry::RtpElement, geometry::Scratch, geometry::SphereSubstrate,
    geometry::Substrate, geometry::TriangularCube, schema::Document, schema::Value;

Value list_of(std::span<const double> values) {
  return std::vector<double>(values.begin(), values.end());
}

Value text_of(std::string_view word) {
  return std::string(word);
}

/// Sets the keys of a table one after another. A key on which other keys depend must be set before them.
class Keys {
 public:
  Keys(Document& document, std::string table) : document_(document), table_(std::move(table)) {
    document_.set(table_, {});
  }
  void set(std::string_view key, Value value) { document_.set(schema::path_in(table_, key), std::move(value)); }
  void set_word(std::string_view key, std::string_view word) { set(key, text_of(word)); }
  /// Sets a key to one of its allowed words.
  /// \param index index of the word in the list of words that are allowed with the keys set so far
  template <class Enum>
  void set_choice(std::string_view key, Enum index) {
    const schema::Row* const row = document_.row(schema::path_in(table_, key));
    set_word(key, std::get<schema::Word>(row->kind).words[static_cast<std::size_t>(index)]);
  }
  void set_positive(std::string_view key, double value) {
    if (value > 0.0) set(key, value);
  }

 private:
  Document& document_;
  std::string table_;
};

std::string_view word_of(const PartSpec& part) {
  return part.is_pin_bundle ? "pins" : geometry::kArrangementWords[static_cast<std::size_t>(part.array.arrangement)];
}

void set_cant(Keys& keys, const Cant& cant) {
  if (cant.deg == 0.0) return;
  keys.set("cant_deg", cant.deg);
  keys.set("cant_azimuth_deg", cant.azimuth_deg);
}

void set_cube(Keys& keys, std::string_view kind, double aperture_mm, const Cant& cant) {
  keys.set_word("kind", kind);
  keys.set("aperture_mm", aperture_mm);
  set_cant(keys, cant);
}

/// Returns the outline of an array or of a round cube corner, or null if the design has no outline.
const geometry::PlanRegion* outline_of(const PartSpec& part) {
  const auto* const cube = std::get_if<RoundCube>(&part.element);
  return cube != nullptr ? cube->outline.get() : part.array.outline.get();
}

void set_round_cube(Keys& keys, const RoundCube& cube, double thickness_mm, bool is_hollow) {
  keys.set_word("kind", "round_icc");
  keys.set("diameter_mm", cube.diameter_mm);
  keys.set("length_mm", geometry::element_depth_mm(cube) + thickness_mm);
  set_cant(keys, cube.cant);
  keys.set_positive("chamfer_mm", cube.chamfer_mm);
  keys.set_positive("recess_mm", cube.recess_mm);
  keys.set_positive("mount_diameter_mm", cube.mount_diameter_mm);
  if (is_hollow) keys.set("hollow", true);
}

void set_element(Document& document, const PartSpec& part, bool is_hollow) {
  Keys keys(document, "element");
  std::visit(
      Overloaded{[&](const RtpElement& prism) {
                   keys.set_word("kind", "rtp");
                   keys.set("base_mm", prism.base_mm);
                   keys.set("width_mm", prism.width_mm);
                   keys.set("apex_angle_deg", prism.apex_angle_deg);
                 },
                 [&](const HexagonalCube& cube) { set_cube(keys, "hexagonal_icc", cube.aperture_mm, cube.cant); },
                 [&](const TriangularCube& cube) { set_cube(keys, "triangular_icc", cube.aperture_mm, cube.cant); },
                 [&](const RoundCube& cube) { set_round_cube(keys, cube, part.thickness_mm, is_hollow); },
                 [&](const geometry::RuledCells& ruled) {
                   keys.set_word("kind", "ruled");
                   set_grooves(document, ruled);
                 }},
      part.element);
}

/// Writes all borders of an outline with their arcs, in the part frame.
/// \pre all holes are round
void set_borders(Keys& keys, const geometry::PlanRegion& plan) {
  std::vector<std::vector<double>> corners;
  std::vector<double> sagitta;
  for (const geometry::OutlineSide& side : plan.outline.loops.front()) {
    corners.push_back({side.from_mm.x(), side.from_mm.y()});
    sagitta.push_back(0.5 * side.bulge * side.chord_mm());
  }
  if (geometry::is_circle(plan.outline.loops.front())) {
    const geometry::OutlineSide& half = plan.outline.loops.front().front();
    keys.set("circle_mm", std::vector{half.centre_mm().x(), half.centre_mm().y(), half.radius_mm()});
  } else {
    keys.set("polygon_mm", std::move(corners));
    if (std::ranges::any_of(sagitta, [](double height) { return height != 0.0; }))
      keys.set("side_sagitta_mm", std::move(sagitta));
  }
  std::vector<std::vector<double>> holes;
  for (std::size_t k = 1; k < plan.outline.loops.size(); ++k) {
    const geometry::OutlineSide& half = plan.outline.loops[k].front();
    holes.push_back({half.centre_mm().x(), half.centre_mm().y(), half.radius_mm()});
  }
  if (!holes.empty()) keys.set("holes_mm", std::move(holes));
}

/// Writes an outline. Uses the keys from which the outline was made, or its borders if there are no such keys.
void set_outline(Document& document, const geometry::PlanRegion& plan, const OutlineKeys& given) {
  Keys keys(document, "outline");
  keys.set("margin_mm", plan.margin_mm);
  keys.set("tolerance_mm", plan.tolerance_mm);
  for (const auto& [key, value] : given.values) keys.set(key, value);
  if (given.values.empty()) set_borders(keys, plan);
}

void set_array(Document& document, const ElementArray& elements) {
  const PartSpec& part = elements.part;
  if (const auto* const outline = outline_of(part)) set_outline(document, *outline, elements.outline);
  Keys keys(document, "array");
  keys.set_word("arrangement", word_of(part));
  if (part.array.arrangement == Arrangement::single) return;
  keys.set_choice("extent", part.array.extent);
  if (part.array.extent == Extent::finite) {
    if (!part.array.outline) {
      keys.set("x_length_mm", part.array.x_length_mm);
      keys.set("y_length_mm", part.array.y_length_mm);
      keys.set("x_offset_mm", part.array.x_offset_mm);
      keys.set("y_offset_mm", part.array.y_offset_mm);
    }
    keys.set_choice("partial_elements", part.array.partial_elements);
  }
  if (std::holds_alternative<RtpElement>(part.element)) {
    keys.set("x_gap_mm", part.array.x_gap_mm);
    keys.set("y_gap_mm", part.array.y_gap_mm);
  }
  if (part.array.arrangement == Arrangement::offset) {
    keys.set("overlap_percent", part.array.overlap_percent);
    keys.set_choice("shifted_rows", part.array.shifted_rows);
  }
  if (elements.cell_spread) {
    keys.set("depth_spread_nm", elements.cell_spread->depth_nm);
    keys.set("spacing_spread_nm", elements.cell_spread->spacing_nm);
  }
  if (!elements.mask) return;
  keys.set_word("mask", elements.mask->name);
  keys.set("mask_threshold", elements.mask->threshold);
}

void set_step_face(Keys& keys, const geometry::StepFace& face) {
  keys.set_word("file", face.name);
  keys.set_word("face", face.choice.face);
  keys.set("sew_mm", face.choice.sew_mm);
  if (face.choice.origin_mm) keys.set("origin_mm", list_of(*face.choice.origin_mm));
  keys.set("rotation_deg", list_of(face.choice.rotation_deg));
}

void set_substrate(Document& document, const Substrate& substrate) {
  Keys keys(document, "substrate");
  keys.set_choice("kind", substrate.shape.index());
  std::visit(Overloaded{[&](const PlaneSubstrate& plane) {
                          keys.set("incline_deg", plane.incline_deg);
                          keys.set("azimuth_deg", plane.azimuth_deg);
                        },
                        [&](const CylinderSubstrate& cylinder) {
                          keys.set("radius_mm", cylinder.radius_mm);
                          keys.set_word("axis", cylinder.axis_is_x ? "x" : "y");
                        },
                        [&](const SphereSubstrate& sphere) { keys.set("radius_mm", sphere.radius_mm); },
                        [&](const FormulaSubstrate& formula) { keys.set_word("sag_mm", formula.sag_mm->text); },
                        [&](const geometry::OffsetSubstrate& offset) { keys.set("wall_mm", offset.wall_mm); },
                        [&](const geometry::StepFace& face) { set_step_face(keys, face); }},
             substrate.shape);
  if (std::holds_alternative<geometry::OffsetSubstrate>(substrate.shape)) return;
  keys.set_word("element_axes", substrate.element_axes == ElementAxes::normal ? "normal" : "parallel");
}

void set_balls(Document& document, const raytrace::BallLayer& balls) {
  Keys element(document, "element");
  element.set_word("kind", "ball");
  element.set("diameter_mm", balls.diameter_mm);
  element.set("mirror_offset_mm", balls.mirror_offset_mm);
  element.set("mirror_half_angle_deg", balls.mirror_half_angle_deg);
  Keys array(document, "array");
  array.set_word("arrangement", balls.pitch_mm ? "packed" : "single");
  if (!balls.pitch_mm) return;
  array.set_word("extent", "infinite");
  array.set("gap_mm", *balls.pitch_mm - balls.diameter_mm);
}

/// Writes the regions of a zone. If all regions are rectangles, they are written as
/// [[x_from, y_from, x_to, y_to], ...]. Otherwise, the zone has only one region, and the corners of this polygon are
/// written.
void set_regions(Keys& keys, const std::vector<geometry::Polygon>& regions) {
  std::vector<std::vector<double>> boxes;
  for (const geometry::Polygon& region : regions) {
    const geometry::Rectangle box = geometry::bounding_box(region);
    if (region == geometry::to_polygon(box))
      boxes.push_back({box.lower.x(), box.lower.y(), box.upper.x(), box.upper.y()});
  }
  if (boxes.size() == regions.size()) return keys.set("rectangles_mm", std::move(boxes));
  std::vector<std::vector<double>> corners;
  for (const geometry::Vec2& p : regions.front()) corners.push_back({p.x(), p.y()});
  keys.set("polygon_mm", std::move(corners));
}

void set_elements(Keys& keys, const ElementsOfZone& chosen) {
  if (!chosen.rows.empty()) keys.set("rows", chosen.rows);
  if (!chosen.columns.empty()) keys.set("columns", chosen.columns);
  if (chosen.every) keys.set("every", *chosen.every);
  if (chosen.mask) {
    keys.set_word("mask", chosen.mask->name);
    keys.set("mask_threshold", chosen.mask->threshold);
  }
  if (chosen.is_remainder) keys.set("rest", true);
}

void set_zones(Document& document, const ZonedPart& part) {
  document.set("zone", {});
  for (std::size_t k = 0; k < part.spec.zones.size(); ++k) {
    Keys zone(document, schema::path_of_entry("zone", k));
    if (part.spec.is_by_cell)
      set_elements(zone, part.elements[k]);
    else
      set_regions(zone, part.spec.zones[k].regions);
    zone.set("rotation_deg", part.spec.zones[k].rotation_deg);
    std::vector<std::string> changes;
    for (const ZoneChange& change : part.changes[k]) changes.push_back(change.text);
    if (!changes.empty()) zone.set("set", std::move(changes));
  }
}

/// Sets the tables that describe the shape.
void set_shape(Document& document, const Design& design) {
  std::visit(Overloaded{[&](const ElementArray& array) {
                          set_element(document, array.part, design.substance.is_hollow);
                          set_array(document, array);
                          if (array.part.substrate) set_substrate(document, *array.part.substrate);
                          if (array.facet_planes) Keys(document, "part").set_word("facets", array.facet_planes->name);
                        },
                        [&](const PartMesh& mesh) {
                          const MeshKeys keys = mesh_keys_of(design);
                          Keys part(document, "part");
                          part.set_word(keys.is_solid ? "solid" : "mesh", mesh.name);
                          part.set("rotate_deg", list_of(keys.rotate_deg));
                          part.set_choice("facing", keys.faces_down ? 1 : 0);
                          if (keys.is_solid) return part.set("chord_mm", keys.chord_mm);
                          part.set("scale", keys.scale);
                          part.set("weld_mm", keys.weld_mm);
                          part.set("allow_open", mesh.allow_open);
                        },
                        [&](const Plate& plate) { Keys(document, "part").set("plate_mm", list_of(plate.size_mm)); },
                        [&](const ZonedPart& part) {
                          set_element(document, part.base, false);
                          set_array(document, {part.base, {}, {}, part.outline});
                          set_zones(document, part);
                        },
                        [&](const raytrace::BallLayer& balls) { set_balls(document, balls); }},
             design.shape);
}

void set_entrance_form(Keys& keys, const EntranceForm& form) {
  keys.set_choice("kind", form.shape.index());
  std::visit(
      Overloaded{[](const geometry::PlaneEntrance&) {},
                 [&](const geometry::BiconicEntrance& biconic) {
                   keys.set("radii_mm", list_of(biconic.radii_mm));
                   keys.set("conics", list_of(biconic.conics));
                 },
                 [&](const geometry::FormulaEntrance& formula) { keys.set_word("formula", formula.height_mm->text); },
                 [&](const geometry::StepFace& face) { set_step_face(keys, face); },
                 [&](const auto& conical) {
                   keys.set("radius_mm", conical.radius_mm);
                   keys.set("conic", conical.conic);
                 }},
      form.shape);
  if (!std::holds_alternative<geometry::StepFace>(form.shape)) keys.set("rotation_deg", form.rotation_deg);
  keys.set("incidence_deg", form.inclination.incidence_deg);
  keys.set("azimuth_deg", form.inclination.azimuth_deg);
  if (form.has_pin_angle) keys.set("pin_angle_deg", form.inclination.pin_angle_deg);
}

void set_entrance_file(Keys& keys, const Design& design, const EntranceFile& file) {
  keys.set_word(file.is_mesh ? "mesh" : "turned_part", file.name);
  if (!file.is_mesh) return;
  keys.set("scale", mesh_scale(design, "entrance_surface"));
  keys.set_choice("mesh_side", file.mesh_bottom);
}

void set_entrance(Document& document, const Design& design) {
  const CurvedEntrance& entrance = *design.entrance;
  Keys keys(document, "entrance_surface");
  if (entrance.form() != nullptr)
    set_entrance_form(keys, *entrance.form());
  else
    set_entrance_file(keys, design, *entrance.file());
  if (entrance.centre_mm) keys.set("centre_mm", list_of(*entrance.centre_mm));
}

Value absorption_value(const Absorption& absorption) {
  return std::visit(Overloaded{[](std::monostate) { return Value(); }, [](double per_mm) { return Value(per_mm); },
                               [](const std::vector<SpectralAbsorption>& curve) {
                                 std::vector<std::vector<double>> pairs;
                                 for (const auto& [wavelength_nm, per_mm] : curve)
                                   pairs.push_back({wavelength_nm, per_mm});
                                 return Value(pairs);
                               }},
                    absorption);
}

/// Returns true if the substrate follows the entrance surface, so that the elements are placed below this surface.
bool is_below_entrance(const Design& design) {
  return design.elements() && design.part().substrate &&
         std::holds_alternative<geometry::OffsetSubstrate>(design.part().substrate->shape);
}

void set_material(Keys& keys, const Substance& substance) {
  keys.set_word("material", substance.material);
  if (substance.catalogue) keys.set_word("catalogue", substance.catalogue->name);
  if (substance.refractive_index) keys.set("refractive_index", *substance.refractive_index);
  if (substance.temperature_c) keys.set("temperature_c", *substance.temperature_c);
  if (const Value absorption = absorption_value(substance.absorption_per_mm); absorption.index() != 0)
    keys.set("absorption_per_mm", absorption);
}

void set_body(Document& document, const Design& design) {
  Keys keys(document, "body");
  const bool is_round = design.elements() != nullptr && std::holds_alternative<RoundCube>(design.part().element);
  if (!is_below_entrance(design) && !is_round) keys.set_positive("thickness_mm", design.thickness_mm());
  if (!design.substance.is_hollow) set_material(keys, design.substance);
  if (design.surface.coating.has_only_aluminium_on_facets()) keys.set_word("facet_coating", "aluminium");
  if (design.substance.back_index != 1.0) keys.set("back_index", design.substance.back_index);
}

void set_shells(Document& document, const std::vector<OuterShell>& shells) {
  if (!shells.empty()) document.set("shell", {});
  for (std::size_t k = 0; k < shells.size(); ++k) {
    const OuterShell& shell = shells[k];
    Keys keys(document, schema::path_of_entry("shell", k));
    keys.set("thickness_mm", shell.thickness_mm);
    keys.set("gap_mm", shell.gap_mm);
    keys.set_word("material", shell.material);
    if (shell.refractive_index) keys.set("refractive_index", *shell.refractive_index);
    if (const Value absorption = absorption_value(shell.absorption_per_mm); absorption.index() != 0)
      keys.set("absorption_per_mm", absorption);
    if (shell.outer_radius_mm) keys.set("outer_radius_mm", *shell.outer_radius_mm);
    if (shell.inner_radius_mm) keys.set("inner_radius_mm", *shell.inner_radius_mm);
    keys.set("wedge_deg", list_of(shell.wedge_deg));
    keys.set("tilt_deg", list_of(shell.tilt_deg));
  }
}

void set_wet_back(Document& document, const WetElements& wet) {
  Keys keys(document, "wet_back");
  keys.set("index", wet.index);
  std::visit(
      Overloaded{[&](const geometry::RandomFraction& random) {
                   keys.set("fraction", random.fraction);
                   keys.set("seed", static_cast<double>(random.seed));
                 },
                 [&](const geometry::Rectangle& r) {
                   keys.set("rectangle_mm", std::vector{r.lower.x(), r.lower.y(), r.upper.x(), r.upper.y()});
                 },
                 [&](const geometry::Disc& disc) {
                   keys.set("disc_mm", std::vector{disc.centre_mm.x(), disc.centre_mm.y(), disc.radius_mm});
                 },
                 [&](const geometry::HalfPlane& half) {
                   keys.set("half_plane", std::vector{half.through_mm.x(), half.through_mm.y(), half.azimuth_deg});
                 }},
      wet.where);
}

void set_layers(Document& document, const std::string& list, const std::vector<CoatingLayer>& layers) {
  if (!layers.empty()) document.set(list, {});
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const CoatingLayer& layer = layers[i];
    Keys entry(document, schema::path_of_entry(list, i));
    if (!layer.material.empty()) {
      entry.set_word("material", layer.material);
    } else {
      entry.set("refractive_index", layer.refractive_index);
      entry.set("extinction_coefficient", layer.extinction_coefficient);
    }
    if (layer.thickness_nm) entry.set("thickness_nm", *layer.thickness_nm);
  }
}

void set_coating(Document& document, const Coating& coating) {
  const bool sets_facets = !coating.facets.empty() && !coating.has_only_aluminium_on_facets();
  if (!sets_facets && coating.entrance.empty()) return;
  document.set("coating", {});
  if (sets_facets) set_layers(document, "coating.facets", coating.facets);
  set_layers(document, "coating.entrance", coating.entrance);
}

void set_entrance_face(Document& document, const EntranceState& face) {
  if (face.is_clean()) return;
  Keys keys(document, "entrance");
  const auto set_share = [&](std::string_view key, double share, std::string_view needed,
                             const std::optional<double>& value) {
    keys.set_positive(key, share);
    if (share > 0.0) keys.set(needed, *value);
  };
  keys.set_positive("film_coverage", face.film_coverage);
  keys.set("water_index", face.water_index);
  set_share("drop_coverage", face.drop_coverage, "drop_contact_angle_deg", face.drop_contact_angle_deg);
  set_share("dust_coverage", face.dust_coverage, "dust_albedo", face.dust_albedo);
  set_share("dust_coverage", face.dust_coverage, "dust_forward_fraction", face.dust_forward_fraction);
  set_share("scratch_coverage", face.scratch_coverage, "scratch_spread_deg", face.scratch_spread_deg);
  if (face.scratch_coverage > 0.0 && face.scratch_azimuth_deg)
    keys.set("scratch_azimuth_deg", *face.scratch_azimuth_deg);
  set_share("haze", face.haze, "haze_spread_deg", face.haze_spread_deg);
  keys.set_positive("roughness_sq_nm", face.roughness_sq_nm);
  if (face.roughness_sq_nm > 0.0) keys.set("correlation_length_um", face.correlation_length_um);
  if (!face.layers.empty()) document.set("entrance.layers", {});
  for (std::size_t i = 0; i < face.layers.size(); ++i) {
    Keys entry(document, schema::path_of_entry("entrance.layers", i));
    entry.set("refractive_index", face.layers[i].refractive_index);
    entry.set("thickness_um", face.layers[i].thickness_um);
    entry.set("absorption_per_mm", face.layers[i].absorption_per_mm);
  }
}

/// Returns the spectrum as a value of a design file.
Value spectrum_value(const LightSpectrum& spectrum) {
  if (spectrum.kind == LightSpectrum::Kind::illuminant_a) return text_of("A");
  if (spectrum.kind == LightSpectrum::Kind::illuminant_d65) return text_of("D65");
  if (spectrum.kind == LightSpectrum::Kind::file) return spectrum.name;
  std::vector<std::vector<double>> lines;
  for (const LightSpectrum::Line& line : spectrum.lines) lines.push_back({line.wavelength_nm, line.power});
  return lines;
}

/// Returns the polarisation as a word of the design file, or as [i, q, u, v] if there is no such word.
Value polarisation_value(const raytrace::Stokes& stokes) {
  const std::array<double, 4> values = stokes.values();
  if (values == raytrace::kUnpolarised.values()) return text_of("unpolarised");
  if (values == std::array{1.0, 0.0, 0.0, 1.0}) return text_of("right_circular");
  if (values == std::array{1.0, 0.0, 0.0, -1.0}) return text_of("left_circular");
  return list_of(values);
}

void set_light(Document& document, const Design& design) {
  Keys keys(document, "light");
  if (const LightSpectrum* const spectrum = design.light.spectrum()) {
    keys.set("spectrum", spectrum_value(*spectrum));
    keys.set_word("weighting", spectrum->photopic ? "photopic" : "radiant");
  } else {
    keys.set("wavelength_nm", design.light.wavelength_nm());
  }
  keys.set("polarisation", polarisation_value(design.light.polarisation));
}

void set_angle_errors(Keys& keys, const PartSpec& part) {
  if (std::holds_alternative<geometry::RuledCells>(part.element)) return;
  const auto& [dihedral, tilt] = part.angle_errors;
  const bool is_prism = std::holds_alternative<RtpElement>(part.element);
  keys.set("dihedral_error_arcmin", is_prism ? Value(dihedral[0]) : list_of(dihedral));
  keys.set("facet_tilt_arcmin", list_of(std::span(tilt).first(is_prism ? 2 : 3)));
  if (!(part.random_tilts.sigma_arcmin > 0.0)) return;
  keys.set("angle_error_sigma_arcmin", part.random_tilts.sigma_arcmin);
  keys.set("angle_error_seed", static_cast<double>(part.random_tilts.seed));
}

void set_height(Keys& keys, std::string_view height, double sq_nm, std::string_view length, double length_um) {
  if (!(sq_nm > 0.0)) return;
  keys.set(height, sq_nm);
  keys.set(length, length_um);
}

void set_texture(Keys& keys, const Surface& surface) {
  if (surface.absorbing_walls) keys.set_word("walls", "absorbing");
  if (surface.is_smooth()) return;
  keys.set_choice("model", surface.texture.index());
  std::visit(
      Overloaded{[](const SmoothTexture&) {},
                 [&](const HarveyShackTexture& t) {
                   set_height(keys, "roughness_sq_nm", t.roughness_sq_nm, "correlation_length_um",
                              t.correlation_length_um);
                   if (t.roughness_sq_nm > 0.0 && t.down_correlation_length_um > 0.0)
                     keys.set("correlation_length_down_um", t.down_correlation_length_um);
                   set_height(keys, "waviness_sq_nm", t.waviness_sq_nm, "waviness_length_um", t.waviness_length_um);
                 },
                 [&](const AbgTexture& t) {
                   keys.set("abg_a", t.a);
                   keys.set("abg_b", t.b);
                   keys.set("abg_g", t.g);
                 },
                 [&](const MicrofacetTexture& t) {
                   keys.set_choice("slope_distribution", t.ggx);
                   set_height(keys, "waviness_sq_nm", t.waviness_sq_nm, "waviness_length_um", t.waviness_length_um);
                 },
                 [&](const HeightMapTexture& t) {
                   keys.set_word("height_map", t.name);
                   keys.set_choice("height_map_horizontal_axis", t.horizontal_axis);
                   keys.set_choice("height_map_form", t.form_degree - 1);
                 }},
      surface.texture);
}

void set_edges(Keys& keys, const EdgeShape& edges) {
  keys.set_positive("root_radius_um", kUmPerMm * edges.root_radius_mm);
  keys.set_positive("root_chamfer_um", kUmPerMm * edges.root_chamfer_mm);
  keys.set_positive("rim_radius_um", kUmPerMm * edges.rim_radius_mm);
  keys.set_positive("rim_chamfer_um", kUmPerMm * edges.rim_chamfer_mm);
  if (!edges.is_sharp()) keys.set("edge_chords", static_cast<double>(edges.chords));
}

void set_surface(Document& document, const Design& design) {
  Keys keys(document, "surface");
  const PartSpec* const part = design.elements() ? &design.part() : design.zoned() ? &design.zoned()->base : nullptr;
  if (part != nullptr) set_angle_errors(keys, *part);
  set_texture(keys, design.surface);
  if (part == nullptr) return;
  set_edges(keys, part->edges);
  std::size_t index = 0;
  for (const Scratch& scratch : part->scratches) {
    document.set("surface.scratches", {});
    Keys entry(document, schema::path_of_entry("surface.scratches", index++));
    entry.set_choice("facet", scratch.facet);
    entry.set("position_um", kUmPerMm * scratch.position_mm);
    entry.set("width_um", kUmPerMm * scratch.width_mm);
    entry.set("depth_um", kUmPerMm * scratch.depth_mm);
  }
}

void set_form(Document& document, const FormOfFacets& form) {
  if (form.is_plane()) return;
  Keys keys(document, "form");
  if (form.sink_um != 0.0) keys.set("sink_um", form.sink_um);
  if (form.map) {
    keys.set_word("map", form.map->name);
    keys.set_choice("map_horizontal_axis", form.map->horizontal_axis);
    keys.set("map_degree", static_cast<double>(form.map->degree));
  }
  for (std::size_t i = 0; i < form.terms.size(); ++i) {
    document.set("form.terms", {});
    Keys entry(document, schema::path_of_entry("form.terms", i));
    entry.set("x_power", static_cast<double>(form.terms[i].x_power));
    entry.set("y_power", static_cast<double>(form.terms[i].y_power));
    entry.set("height_um", form.terms[i].height_um);
  }
}

}  // namespace

Document document_of(const Design& design) {
  Document document(design_format().root);
  if (!design.title.empty()) document.set("title", design.title);
  set_shape(document, design);
  if (design.entrance) set_entrance(document, design);
  set_shells(document, design.shells);
  set_body(document, design);
  if (design.wet_back) set_wet_back(document, *design.wet_back);
  set_coating(document, design.surface.coating);
  set_entrance_face(document, design.surface.entrance);
  set_light(document, design);
  Keys(document, "detector").set("acceptance_half_angle_deg", design.detector.acceptance_half_angle_deg);
  if (!design.balls()) set_surface(document, design);
  set_form(document, design.surface.form);
  Keys idealisation(document, "idealisation");
  idealisation.set_choice("facets", design.idealisation.mirror_facets);
  idealisation.set_choice("entrance", design.idealisation.lossless_entrance);
  return document;
}

std::string design_text(const Design& design, const std::string& comment) {
  return comment + schema::document_text(design_format(), schema::without_defaults(document_of(design)));
}

}  // namespace retrace::design
