#include "design/io/design_rules.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

#include "core/angle.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "design/io/entrance_checks.h"
#include "design/io/groove_reader.h"
#include "design/io/optics_checks.h"
#include "design/io/outline_reader.h"
#include "design/io/part_reader.h"
#include "design/io/round_cube_checks.h"
#include "design/io/zone_reader.h"
#include "geometry/elements/edges.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/ruled_pattern.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/io/substrate_rows.h"

namespace retrace::design {
namespace {

using geometry::AngleErrors, geometry::Arrangement, geometry::Cell, geometry::EdgeShape, geometry::ElementAxes,
    geometry::Extent, geometry::HexagonalCube, geometry::PartSpec, geometry::PlaneSubstrate, geometry::RoundCube,
    geometry::RtpElement, geometry::Scratch, geometry::TriangularCube, schema::Document;

/// Maximum number of elements of a design. It keeps element numbers within 32 bits and limits the memory.
constexpr double kMaxElements = 1e8;
constexpr std::size_t kMaxScratches = 200;
/// Relative tolerance within which lengths count as a whole number of elements, and sizes count as equal.
constexpr double kRelativeTolerance = 1e-9;
constexpr NumberRange kApexAngle{.low = 60.0, .high = 120.0};

bool is_prism(const PartSpec& part) {
  return std::holds_alternative<RtpElement>(part.element);
}

std::string of_range(const NumberRange& range, double given) {
  return fmt::format("must be {}, got {}", range.text(), shortest(given));
}

/// Applies a rule to the part if the design consists of elements.
template <void (*check)(const Document&, const PartSpec&)>
void of_part(const Document& document) {
  if (has_elements(document)) check(document, read_part(document));
}
/// Applies a rule to the array, before angle errors, edges and the base are read.
template <void (*check)(const Document&, const PartSpec&)>
void of_array(const Document& document) {
  if (has_elements(document)) check(document, read_array(document));
}

void check_square(const Document& document, const PartSpec& part) {
  if (part.array.arrangement != Arrangement::checker) return;
  const auto& rtp = std::get<RtpElement>(part.element);
  if (std::abs(rtp.base_mm - rtp.width_mm) <= kRelativeTolerance * rtp.base_mm) return;
  document.fail("element.width_mm", fmt::format("must equal base_mm ({}) for array.arrangement = \"checker\", got {}",
                                                shortest(rtp.base_mm), shortest(rtp.width_mm)));
}

/// Bounding box of an element's aperture, in mm, and area, in mm^2, of the cell in which the element repeats.
struct Footprint {
  double x_mm;
  double y_mm;
  double cell_area_mm2;
};

struct FootprintOf {
  const PartSpec& part;

  Footprint operator()(const RtpElement& rtp) const {
    return {rtp.base_mm, rtp.width_mm, (rtp.base_mm + part.array.x_gap_mm) * (rtp.width_mm + part.array.y_gap_mm)};
  }
  /// Returns the footprint of a hexagon with vertices on the positive and negative x axis.
  Footprint operator()(const HexagonalCube& cube) const {
    const double radius = cube.aperture_mm / 2.0;
    return {2.0 * radius, std::numbers::sqrt3 * radius, 1.5 * std::numbers::sqrt3 * radius * radius};
  }
  /// Returns the footprint of a round cube corner, which is its circular face.
  Footprint operator()(const RoundCube& cube) const {
    return {cube.diameter_mm, cube.diameter_mm, 0.25 * std::numbers::pi * cube.diameter_mm * cube.diameter_mm};
  }
  /// Returns the bounding box of the largest cell and the mean area of the cells.
  Footprint operator()(const geometry::RuledCells& ruled) const {
    const geometry::Vec2 size = geometry::bounding_box(geometry::aperture_outline(ruled)).size();
    return {size.x(), size.y(), ruled.pattern->mean_cell_mm2};
  }
  /// Returns the footprint of a triangle whose apex is at the centre of the part. A vertex of the triangle is on the x
  /// axis, one radius from the apex. The part therefore extends over two radii along x.
  Footprint operator()(const TriangularCube& cube) const {
    const double radius = cube.aperture_mm / 2.0;
    return {2.0 * radius, std::numbers::sqrt3 * radius, 0.75 * std::numbers::sqrt3 * radius * radius};
  }
};

void check_length(const Document& document, std::string_view key, double length_mm, double margin_mm,
                  double element_mm) {
  const double free_mm = length_mm - 2.0 * margin_mm;
  if (free_mm >= element_mm * (1.0 - kRelativeTolerance)) return;
  const std::string margins = margin_mm > 0.0 ? fmt::format(" and two margins of {} mm", shortest(margin_mm)) : "";
  document.fail(
      key, fmt::format("must be >= {} to hold one element of {} mm{}, got {}", shortest(element_mm + 2.0 * margin_mm),
                       shortest(element_mm), margins, shortest(length_mm)));
}

void check_room(const Document& document, const PartSpec& part) {
  if (part.array.extent == Extent::infinite || part.array.arrangement == Arrangement::single) return;
  const Footprint footprint = std::visit(FootprintOf{part}, part.element);
  const bool is_cut = has_outline(document);
  const std::string_view x_key = is_cut ? outline_key(document) : "array.x_length_mm";
  const std::string_view y_key = is_cut ? outline_key(document) : "array.y_length_mm";
  check_length(document, x_key, part.array.x_length_mm, part.array.x_offset_mm, footprint.x_mm);
  check_length(document, y_key, part.array.y_length_mm, part.array.y_offset_mm, footprint.y_mm);
  const double x_free_mm = part.array.x_length_mm - 2.0 * part.array.x_offset_mm + part.array.x_gap_mm;
  const double y_free_mm = part.array.y_length_mm - 2.0 * part.array.y_offset_mm + part.array.y_gap_mm;
  const double count = x_free_mm * y_free_mm / footprint.cell_area_mm2;
  if (!(count <= kMaxElements * (1.0 + kRelativeTolerance)))
    document.fail(x_key, fmt::format("the array would have {:.6g} elements, but at most {:.0f} are "
                                     "allowed: make the array smaller or its elements larger",
                                     count, kMaxElements));
}

constexpr std::string_view kNotInfinite =
    "not allowed for array.extent = \"infinite\": give x_length_mm and y_length_mm instead";

void check_array_on_substrate(const Document& document, const PartSpec& part) {
  constexpr std::string_view key = "substrate.kind";
  if (!document.has("substrate")) return;
  if (part.array.extent == Extent::infinite) document.fail(key, kNotInfinite);
  if (part.array.arrangement == Arrangement::single)
    document.fail(key, "not allowed for array.arrangement = \"single\"");
  if (document.text(key) == "offset" && !document.has("entrance_surface.kind"))
    document.fail(key, "\"offset\" is only allowed together with entrance_surface.kind");
  if (has_outline(document) && part.array.x_offset_mm > 0.0)
    document.fail(key, "not allowed together with outline.margin_mm");
  if (part.array.x_offset_mm > 0.0 || part.array.y_offset_mm > 0.0)
    document.fail(key, "not allowed together with array.x_offset_mm and y_offset_mm");
}

/// Checks that the outline behind a curved entrance face is convex and has no holes. Also checks that single elements
/// have no outline; only round cube corners may have one.
void check_outline(const Document& document, const PartSpec& part) {
  if (has_outline(document) && part.array.arrangement == Arrangement::single &&
      !std::holds_alternative<RoundCube>(part.element))
    document.fail("outline", "not allowed for array.arrangement = \"single\", except for element.kind = \"round_icc\"");
  if (!part.array.outline || part.array.outline->is_convex() || !document.has("entrance_surface")) return;
  document.fail(document.has("outline.holes_mm") ? "outline.holes_mm" : outline_key(document),
                "must be a convex outline without holes if the design has a table [entrance_surface]");
}

/// Returns the key with which the design specifies the errors of the dihedral angles.
std::string_view dihedral_key(const Document& document) {
  return document.has(kDihedralErrorArcsec) ? kDihedralErrorArcsec : kDihedralErrorArcmin;
}

constexpr std::string_view kFacetTilt = "surface.facet_tilt_arcmin";
constexpr std::string_view kRandomTilt = "surface.angle_error_sigma_arcmin";

void check_dihedral_errors(const Document& document, const PartSpec& part) {
  const std::string_view key = dihedral_key(document);
  const std::size_t count = document.numbers(key).size();
  if (!is_prism(part) && count != 1 && count != 3)
    document.fail(
        key, fmt::format("must be a number or a list of three numbers, one for each dihedral edge, got a list of {}",
                         count));
}

void check_facet_tilts(const Document& document, const PartSpec& part) {
  const std::size_t facets = is_prism(part) ? 2 : 3;
  const std::vector<double> given = document.numbers(kFacetTilt);
  const bool is_list = document.is_list(kFacetTilt);
  if (is_list ? given.size() != facets : given[0] != 0.0)
    document.fail(kFacetTilt, fmt::format("must be 0 or a list of {} numbers, one for each facet, got {}", facets,
                                          is_list ? fmt::format("a list of {}", given.size()) : shortest(given[0])));
}

void check_random_tilts(const Document& document, const PartSpec& part) {
  if (part.random_tilts.sigma_arcmin > 0.0 && part.array.extent == Extent::infinite)
    document.fail(kRandomTilt,
                  "must be 0 for array.extent = \"infinite\", because all elements of an infinite array are equal; "
                  "give lengths instead");
}

constexpr std::string_view kEdges[] = {"surface.root_radius_um", "surface.root_chamfer_um", "surface.rim_radius_um",
                                       "surface.rim_chamfer_um"};

/// Checks that rounded or chamfered edges do not remove a whole facet.
void check_widths(const Document& document, const PartSpec& part) {
  const auto* const rtp = std::get_if<RtpElement>(&part.element);
  const Cell cell = geometry::element_cell(part.element, part.angle_errors);
  const double widest_mm =
      rtp != nullptr ? 0.25 * rtp->base_mm : 0.1 * geometry::bounding_box(cell.outline).size().minCoeff();
  const NumberRange range{.low = 0.0, .high = 1e3 * widest_mm};
  for (const std::string_view key : kEdges)
    if (!range.contains(document.number(key))) document.fail(key, of_range(range, document.number(key)));
}

void check_chords(const Document& document, const PartSpec&) {
  constexpr std::string_view key = "surface.edge_chords";
  const double chords = document.number(key);
  if (std::fmod(chords, 2.0) != 0.0)
    document.fail(key, fmt::format("must be an even number, got {}", shortest(chords)));
}

void check_one_shape(const Document& document, const PartSpec& part) {
  const EdgeShape& edges = part.edges;
  if (edges.root_radius_mm > 0.0 && edges.root_chamfer_mm > 0.0)
    document.fail("surface.root_chamfer_um", "must be 0 if root_radius_um is given");
  if (edges.rim_radius_mm > 0.0 && edges.rim_chamfer_mm > 0.0)
    document.fail("surface.rim_chamfer_um", "must be 0 if rim_radius_um is given");
}

/// Checks that the gap between elements is wide enough for rounded or chamfered rims on both of its sides. Rims are the
/// edges where an element meets another element or the flat land between elements.
void check_land(const Document& document, const PartSpec& part) {
  if (!part.edges.rounds_rims() || !is_prism(part)) return;
  const bool is_checker = part.array.arrangement == Arrangement::checker;
  const double reach_mm = geometry::rim_reach_over_land_mm(part);
  // In a checker array, one of two neighbours is rotated by 90 degrees, so that only one of them has a rim at the gap.
  const double needed_mm = is_checker ? reach_mm : 2.0 * reach_mm;
  const auto check = [&](std::string_view gap, double gap_mm) {
    if (gap_mm <= 0.0 || gap_mm >= needed_mm) return;
    document.fail(part.edges.rim_radius_mm > 0.0 ? "surface.rim_radius_um" : "surface.rim_chamfer_um",
                  fmt::format("this radius or chamfer of the rims requires array.{} = 0 or >= {} mm, got {}", gap,
                              shortest(needed_mm), shortest(gap_mm)));
  };
  check("x_gap_mm", part.array.x_gap_mm);
  if (is_checker) check("y_gap_mm", part.array.y_gap_mm);
}

constexpr std::string_view kScratches = "surface.scratches";

void check_scratch(const Document& document, const PartSpec& part, std::size_t i) {
  const std::string entry = schema::path_of_entry(kScratches, i);
  const double element_um = 1e3 * std::get<RtpElement>(part.element).width_mm;
  const double width_um = document.number(entry + ".width_um");
  const double reach_um = 0.5 * (element_um - width_um);
  if (reach_um <= 0.0)
    document.fail(entry + ".width_um",
                  fmt::format("must be < {}, the element's width, got {}", shortest(element_um), shortest(width_um)));
  const auto check = [&](const std::string& key, double reach) {
    const NumberRange range{.low = -reach, .high = reach};
    if (!range.contains(document.number(key))) document.fail(key, of_range(range, document.number(key)));
  };
  check(entry + ".position_um", reach_um);
  check(entry + ".depth_um", 0.5 * width_um);
  const Scratch& scratch = part.scratches[i];
  for (const Scratch& other : std::span(part.scratches).first(i))
    if (other.facet == scratch.facet && std::abs(other.position_mm - scratch.position_mm) <
                                            0.5 * (other.width_mm + scratch.width_mm) * (1.0 - kRelativeTolerance))
      document.fail(entry + ".position_um", fmt::format("must not overlap the other scratches of its facet, got {}",
                                                        shortest(1e3 * scratch.position_mm)));
}

void check_scratches(const Document& document, const PartSpec& part) {
  if (!document.has(kScratches)) return;
  if (part.substrate) document.fail(kScratches, "not allowed together with [substrate]");
  if (part.scratches.size() > kMaxScratches)
    document.fail(kScratches, fmt::format("must be at most {}, got {}", kMaxScratches, part.scratches.size()));
  for (std::size_t i = 0; i < part.scratches.size(); ++i) check_scratch(document, part, i);
}

/// Returns the key that a message about angle errors names. It is the first key of angle errors that the document
/// contains. If the document contains none, `otherwise` is returned.
std::string_view blamed_error(const Document& document, std::string_view otherwise) {
  for (const std::string_view key : {kDihedralErrorArcmin, kDihedralErrorArcsec, kFacetTilt})
    if (document.has(key)) return key;
  return otherwise;
}

/// Checks that no facet of a canted cube corner becomes almost vertical, and that the apex angle of a prism stays
/// within its range.
void check_angles(const Document& document, const PartSpec& part) {
  if (const auto* const rtp = std::get_if<RtpElement>(&part.element)) {
    const auto& [dihedral, tilt] = part.angle_errors;
    const double apex_deg = rtp->apex_angle_deg + (dihedral[0] + tilt[0] + tilt[1]) / 60.0;
    if (!kApexAngle.contains(apex_deg))
      document.fail(blamed_error(document, kFacetTilt),
                    fmt::format("the apex angle including the angle errors must be {}, got {}", kApexAngle.text(),
                                shortest(apex_deg)));
    return;
  }
  constexpr double steepest_deg = 88.0;
  // Limit of random tilts in standard deviations; fewer than 1 in 10^8 facets exceed it.
  constexpr double deviations = 6.0;
  const double deg = geometry::steepest_facet_deg(part.element, part.angle_errors) +
                     deviations * part.random_tilts.sigma_arcmin / 60.0;
  if (deg > steepest_deg)
    document.fail(blamed_error(document, kRandomTilt),
                  fmt::format("the slope of the facets, including angle errors, must be <= {} degrees, got {}",
                              steepest_deg, fixed_apart(deg, steepest_deg, 2)));
}

void check_mask(const Document& document, const PartSpec& part) {
  if (document.has("array.mask") && part.substrate)
    document.fail("array.mask", "not allowed together with [substrate]");
}

/// Refuses the combination of individual facet planes with keys that rotate or deform all facets.
void check_facet_planes(const Document& document, const PartSpec& part) {
  constexpr std::string_view key = "part.facets";
  if (!document.has(key)) return;
  if (part.array.extent == Extent::infinite) document.fail(key, "only allowed for array.extent = \"finite\"");
  if (part.substrate) document.fail(key, "not allowed together with [substrate]");
  if (!(part.angle_errors == AngleErrors{}) || part.random_tilts.sigma_arcmin > 0.0)
    document.fail(key, "not allowed together with angle errors in [surface], because the planes contain these errors");
}

void check_substrate_of_part(const Document& document, const PartSpec& part) {
  if (!part.substrate) return;
  const std::string_view key = geometry::substrate_shape_key(*part.substrate);
  const bool has_gaps = part.array.x_gap_mm > 0.0 || part.array.y_gap_mm > 0.0;
  const bool is_plane = std::holds_alternative<PlaneSubstrate>(part.substrate->shape);
  if (part.edges.rounds_rims() && part.substrate->element_axes == ElementAxes::normal && (has_gaps || !is_plane))
    document.fail(
        key,
        "rounded or chamfered rims require substrate.element_axes = \"parallel\", or a plane substrate and no gaps");
  // A substrate below the entrance surface or in a file is checked after the surface or the file has been read, by
  // find_offset() or read_step_faces().
  if (std::holds_alternative<geometry::OffsetSubstrate>(part.substrate->shape) ||
      std::holds_alternative<geometry::StepFace>(part.substrate->shape))
    return;
  try {
    geometry::check_substrate(part);
  } catch (const InputError& error) {
    document.fail(key, error.what());
  }
}

/// Checks that the plate is thick enough to cover the highest points of the elements.
void check_thickness(const Document& document, const PartSpec& part) {
  if (std::holds_alternative<RoundCube>(part.element)) return;  // check_length_of_round_cube() checks the thickness
  const double top_mm = geometry::element_top_mm(part.element, part.angle_errors);
  const double least_mm = min_thickness_mm(part);
  if (part.thickness_mm < least_mm)
    document.fail(document.has("substrate.wall_mm") ? "substrate.wall_mm" : "body.thickness_mm",
                  fmt::format("must be >= {} so that the plate is thicker than the height of the "
                              "rims, {} mm (angle errors and a cant raise the rims), got {}",
                              shortest(least_mm), shortest(top_mm), shortest(part.thickness_mm)));
}

void check_bowl(const Document& document) {
  if (document.has("part.mesh") || document.has("part.solid") || document.has("part.plate_mm") ||
      has_elements(document))
    return;
  const double most_deg = read_balls(document).max_mirror_half_angle_deg();
  const auto given_deg = document.number_if("element.mirror_half_angle_deg");
  if (given_deg && *given_deg > most_deg + 1e-9)
    document.fail("element.mirror_half_angle_deg",
                  fmt::format("must be <= {} degrees, the angle at which neighbouring bowls touch, got {}",
                              fixed_apart(most_deg, *given_deg, 6), shortest(*given_deg)));
}

/// Checks that no radius of an entrance surface is 0.
void check_entrance_radii(const Document& document) {
  for (const std::string_view key : {"entrance_surface.radius_mm", "entrance_surface.radii_mm"})
    if (document.has(key) && std::ranges::count(document.numbers(key), 0.0) > 0)
      document.fail(
          key, "must not be 0, got 0; a positive radius is convex towards the light, a negative radius is concave");
}

void check_entrance(const Document& document) {
  if (!document.has("entrance_surface")) return;
  const std::string_view key = document.has("entrance_surface.kind")   ? "entrance_surface.kind"
                               : document.has("entrance_surface.mesh") ? "entrance_surface.mesh"
                                                                       : "entrance_surface.turned_part";
  if (!document.has(key))
    document.fail(key, "is missing: give the kind of the surface, the file of a turned part, or an STL file (mesh)");
  if (has_elements(document) && document.text("array.extent") == "infinite") document.fail(key, kNotInfinite);
  check_entrance_radii(document);
}

constexpr std::string_view kFormTerms = "form.terms";

void check_form(const Document& document) {
  constexpr std::size_t most_terms = 45;
  constexpr double most_degree = 8.0;
  if (!document.has(kFormTerms)) return;
  const std::size_t count = document.count(kFormTerms);
  if (count > most_terms) document.fail(kFormTerms, fmt::format("must be at most {}, got {}", most_terms, count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string entry = schema::path_of_entry(kFormTerms, i);
    const double degree = document.number(entry + ".x_power") + document.number(entry + ".y_power");
    if (degree > most_degree)
      document.fail(entry + ".y_power", fmt::format("must be <= {} for x_power = {}, got {}",
                                                    shortest(most_degree - document.number(entry + ".x_power")),
                                                    shortest(document.number(entry + ".x_power")),
                                                    shortest(document.number(entry + ".y_power"))));
  }
}

constexpr schema::Words kSquareKeys = {"element.base_mm", "element.width_mm"};
constexpr schema::Words kRoomKeys = {"array.x_length_mm", "array.y_length_mm", "array.x_offset_mm",
                                     "array.y_offset_mm"};
constexpr schema::Words kOutlineKeys = {"outline.polygon_mm", "outline.circle_mm",       "outline.dxf",
                                        "outline.file",       "outline.side_sagitta_mm", "outline.corner_radius_mm",
                                        "outline.holes_mm",   "outline.margin_mm",       "outline.tolerance_mm"};
constexpr schema::Words kArrayOnSubstrateKeys = {"substrate.kind", "array.extent", "array.arrangement",
                                                 "array.x_offset_mm", "array.y_offset_mm"};
constexpr schema::Words kDihedralKeys = {kDihedralErrorArcmin, kDihedralErrorArcsec};
constexpr schema::Words kTiltKeys = {kFacetTilt};
constexpr schema::Words kRandomKeys = {kRandomTilt, "array.extent"};
constexpr schema::Words kChordKeys = {"surface.edge_chords"};
constexpr schema::Words kRimKeys = {"surface.rim_radius_um", "surface.rim_chamfer_um", "array.x_gap_mm",
                                    "array.y_gap_mm"};
constexpr schema::Words kScratchKeys = {kScratches, "element.width_mm"};
constexpr schema::Words kAngleKeys = {"element.apex_angle_deg", "element.cant_deg", kDihedralErrorArcmin,
                                      kDihedralErrorArcsec,     kFacetTilt,         kRandomTilt};
constexpr schema::Words kMaskKeys = {"array.mask", "substrate.kind"};
constexpr schema::Words kFacetsKeys = {"part.facets",        "array.extent", "substrate.kind", kDihedralErrorArcmin,
                                       kDihedralErrorArcsec, kFacetTilt,     kRandomTilt};
constexpr schema::Words kSubstrateKeys = {"substrate.kind", "substrate.element_axes", "surface.rim_radius_um",
                                          "surface.rim_chamfer_um"};
constexpr schema::Words kThicknessKeys = {"body.thickness_mm"};
constexpr schema::Words kFormKeys = {kFormTerms};
constexpr schema::Words kBowlKeys = {"element.mirror_half_angle_deg", "array.gap_mm"};
constexpr schema::Words kHeightKeys = {kRoughness, kRoughnessLength, kWaviness, kWavinessLength};
constexpr schema::Words kModelKeys = {"surface.model", kRoughness, kWaviness};
constexpr schema::Words kMaterialKeys = {"body.material"};
constexpr schema::Words kMirrorWord = {"mirror"};
constexpr schema::Words kFacetCoatingKeys = {"body.facet_coating"};
constexpr schema::Words kIndexKeys = {"body.material", "body.catalogue"};
constexpr schema::Words kAbsorptionKeys = {kAbsorption};
constexpr schema::Words kShellKeys = {"shell", "array.extent", "idealisation.entrance"};
constexpr schema::Words kSpectrumKeys = {"light.spectrum"};
constexpr schema::Words kStokesKeys = {"light.polarisation"};
constexpr schema::Words kMirrorKeys = {"element.mirror_offset_mm", "body.facet_coating", "idealisation.facets"};
constexpr schema::Words kWetBackKeys = {"wet_back.rectangle_mm", "wet_back.disc_mm", "array.extent",
                                        "array.arrangement", "substrate.kind"};
constexpr schema::Words kLayerKeys = {kFacetLayers, kEntranceLayers};
constexpr schema::Words kCoatingKeys = {kFacetLayers,          kEntranceLayers,         "body.facet_coating",
                                        "idealisation.facets", "idealisation.entrance", "element.kind"};
constexpr schema::Words kEntranceFaceKeys = {"entrance.layers",
                                             "entrance.film_coverage",
                                             "entrance.drop_coverage",
                                             "entrance.drop_contact_angle_deg",
                                             "entrance.dust_coverage",
                                             "entrance.dust_albedo",
                                             "entrance.dust_forward_fraction",
                                             "entrance.scratch_coverage",
                                             "entrance.scratch_spread_deg",
                                             "entrance.haze",
                                             "entrance.haze_spread_deg",
                                             "entrance.roughness_sq_nm",
                                             "entrance.correlation_length_um",
                                             "idealisation.entrance",
                                             "entrance_surface.kind",
                                             "entrance_surface.turned_part",
                                             "entrance_surface.mesh"};
constexpr schema::Words kZoneKeys = {"zone", "array.extent", "array.x_offset_mm", "array.y_offset_mm"};
constexpr schema::Words kEntranceKeys = {"entrance_surface.kind",      "entrance_surface.turned_part",
                                         "entrance_surface.mesh",      "array.extent",
                                         "entrance_surface.radius_mm", "entrance_surface.radii_mm"};

constexpr schema::Words kGrooveKeys = {"grooves.form",       "grooves.base_angles_deg", "grooves.depth_mm",
                                       "grooves.spacing_mm", "grooves.bottom_flat_um",  "grooves.bottom_radius_um",
                                       "array.extent"};
constexpr schema::Words kRuledKeys = {
    "surface.dihedral_error_arcmin", "surface.facet_tilt_arcmin", kRandomTilt,
    "surface.root_radius_um",        "surface.root_chamfer_um",   "surface.rim_radius_um",
    "surface.rim_chamfer_um",        "array.partial_elements",    "part.facets"};

using schema::check_by;
constexpr schema::Rule kRules[] = {
    schema::Check{kGrooveKeys,
                  "The grooves of ruled cells must leave cells, and their bottoms must be narrower than the spacing. "
                  "The base angles add up to 180 degrees. In an infinite array, the grooves must have a common period "
                  "along x and y with at most 1000 cells.",
                  check_by<check_grooves>},
    schema::Check{
        kRuledKeys,
        "Ruled cells have no angle errors, rims or random tilts in `[surface]`, because `[grooves]` describes "
        "their faces. Roots may be rounded if every cell has three faces and nothing else. The border cuts "
        "the cells. A table of planes, a `[substrate]` and a `[form]` are not allowed.",
        check_by<of_part<check_ruled_part>>},
    schema::Check{kSquareKeys, "Elements of the arrangement `checker` are square: `base_mm` equals `width_mm`.",
                  check_by<of_array<check_square>>},
    schema::Check{
        kRoomKeys,
        "At least one element of a finite array must fit between its margins, and at most 1e8 elements are allowed.",
        check_by<of_array<check_room>>},
    schema::Check{
        kOutlineKeys,
        "An outline must not cross or touch itself. Its holes must be inside it and apart from each other. The "
        "arcs of its corners must fit between their neighbours, and the margin must leave one connected area "
        "for elements. An outline that is not convex, or has holes, is not allowed together with "
        "`[entrance_surface]`. Of the single elements, only `round_icc` may have an outline.",
        check_by<of_array<check_outline>>},
    schema::Check{
        kArrayOnSubstrateKeys,
        "A `[substrate]` is allowed only for finite arrays without margins, and not for the arrangement `single`.",
        check_by<of_array<check_array_on_substrate>>},
    schema::Check{kDihedralKeys,
                  "`dihedral_error_arcmin` is one number for prisms. For cube corners, it is one number for all "
                  "dihedral edges, or a list of three numbers. The same applies to `dihedral_error_arcsec`.",
                  check_by<of_part<check_dihedral_errors>>},
    schema::Check{kTiltKeys,
                  "A list of tilts has one number for each facet: two for prisms, three for cube corners. The single "
                  "number 0 means no tilts.",
                  check_by<of_part<check_facet_tilts>>},
    schema::Check{kRandomKeys, "Random tilts are allowed only for finite parts.",
                  check_by<of_part<check_random_tilts>>},
    schema::Check{kEdges,
                  "The radii and chamfers of edges are at most a quarter of the base, or a tenth of the aperture. A "
                  "part of each facet then remains.",
                  check_by<of_part<check_widths>>},
    schema::Check{kChordKeys, "`edge_chords` must be an even number.", check_by<of_part<check_chords>>},
    schema::Check{kEdges, "Roots may have a radius or a chamfer, but not both. The same rule applies to rims.",
                  check_by<of_part<check_one_shape>>},
    schema::Check{
        kRimKeys,
        "The gap between neighbouring prisms, measured across their roof edges, must be 0 or wide enough for the "
        "rounded or chamfered rims on both of its sides. In the arrangement `checker`, this applies to both gaps.",
        check_by<of_part<check_land>>},
    schema::Check{kScratchKeys,
                  "At most 200 scratches are allowed. A scratch must be completely on its facet, and scratches on the "
                  "same facet must not overlap. None are allowed on a `[substrate]`.",
                  check_by<of_part<check_scratches>>},
    schema::Check{kAngleKeys,
                  "The apex angle of prisms, including `dihedral_error_arcmin` and `facet_tilt_arcmin`, must be 60 to "
                  "120 degrees. The slope of the facets of canted cube corners, including these errors and six "
                  "standard deviations of the random tilts, must be at most 88 degrees.",
                  check_by<of_part<check_angles>>},
    schema::Check{kMaskKeys, "A mask is not allowed on a `[substrate]`.", check_by<of_part<check_mask>>},
    schema::Check{kFacetsKeys,
                  "Tables of planes (`[part]` `facets`) are allowed only for finite arrays without `[substrate]` and "
                  "without angle errors in `[surface]`.",
                  check_by<of_part<check_facet_planes>>},
    schema::Check{
        kSubstrateKeys,
        "The radius of curvature of a `[substrate]` must be at least the width of an element. The slope of "
        "the facets on the substrate must be at most 88 degrees. Rounded or chamfered rims need `element_axes` = "
        "`\"parallel\"`, or a plane substrate and no gaps.",
        check_by<of_part<check_substrate_of_part>>},
    schema::Check{
        kThicknessKeys,
        "The plate of an array must be so thick that it covers rims that are raised by angle errors or a cant.",
        check_by<of_part<check_thickness>>},
    schema::Check{kBowlKeys,
                  "The bowl of a mirror behind a ball extends at most to the angle at which the bowls of neighbouring "
                  "balls meet.",
                  check_by<check_bowl>},
    schema::Check{
        kRoundLengthKeys,
        "The length of a round cube corner must be so large that its facets, including angle errors and a cant, "
        "do not cut its face.",
        check_by<of_part<check_length_of_round_cube>>},
    schema::Check{
        kRoundFaceKeys,
        "The chamfer of a round cube corner is narrower than the radius of its face. A mount and a chamfer are "
        "not allowed together with `[[shell]]`. With an `[outline]`, a chamfer and a margin are not allowed. "
        "The outline must be convex and contain the centre of its bounding box, which is above the apex.",
        check_by<of_part<check_face_of_round_cube>>},
    schema::Check{
        kHollowKeys,
        "A hollow cube corner has mirrors on its facets. The keys of the material, its index and its absorption, and "
        "those of coatings and contamination of the entrance face, are not allowed.",
        check_by<check_hollow>},
    schema::Check{kHeightKeys,
                  "If the rms height of the roughness is above 0, its correlation length is required. If the rms "
                  "height of the waviness is above 0, its period is required.",
                  check_by<check_lengths>},
    schema::Check{kModelKeys,
                  "The rms heights of roughness and waviness must be 0, except for `\"harvey_shack\"`, which uses "
                  "both, and for `\"microfacet\"`, which uses the waviness.",
                  check_by<check_heights>},
    schema::Check{kMaterialKeys, "The name of the material must not be empty.", check_by<check_material>},
    schema::Precedence{schema::is_given("body.refractive_index"), kIndexKeys, "on the refractive index",
                       "`body.refractive_index` takes precedence over the index of the material."},
    schema::Precedence{schema::is("idealisation.facets", kMirrorWord), kFacetCoatingKeys, "on the facets",
                       "`idealisation.facets` = `\"mirror\"` takes precedence over `body.facet_coating`."},
    schema::Precedence{.winner = schema::is_given("body.absorption_per_mm"),
                       .keys = kIndexKeys,
                       .effect = "on the absorption",
                       .meaning = "`body.absorption_per_mm` takes precedence over the absorption of the material.",
                       .is_refinement = true},
    schema::Check{kAbsorptionKeys, "The wavelengths of an absorption curve must be in ascending order.",
                  check_by<check_absorption>},
    schema::Check{kShellKeys,
                  "At most 4 shells are allowed. Their radii must not be 0. In front of an infinite array, shells must "
                  "be plane-parallel and must not be tilted. With `idealisation.entrance` = `\"lossless\"`, none are "
                  "allowed. The surfaces of a shell must extend over the whole part and must not cross each other, the "
                  "next shell or the part.",
                  check_by<check_shells>},
    schema::Check{kSpectrumKeys, "A list of spectral lines must contain each wavelength only once.",
                  check_by<check_lines>},
    schema::Check{kStokesKeys, "The degree of polarisation is at most 1: q^2 + u^2 + v^2 <= i^2.",
                  check_by<check_stokes>},
    schema::Check{kWetBackKeys,
                  "A `[wet_back]` is allowed only for finite arrays without a `[substrate]`, and not for the "
                  "arrangement `single`. The two lengths of its rectangle and the radius of its disc must be above 0.",
                  check_by<check_wet_back>},
    schema::Check{kLayerKeys,
                  "A face may have at most 200 layers. Layers without a thickness are opaque. At most one opaque layer "
                  "is allowed on the facets, and none on the entrance face.",
                  check_by<check_layers>},
    schema::Check{kCoatingKeys,
                  "Layers are allowed only on faces that are not idealised and have no other coating. Layers behind "
                  "balls must form a mirror.",
                  check_by<check_coating>},
    schema::Check{
        kEntranceFaceKeys,
        "If the coverage of drops, dust or scratches, or the haze, is above 0, the keys that describe it are required. "
        "Drops, dust and scratches together cover at most the whole face. The haze is at most the fraction of its lobe "
        "beyond 2.5 degrees. A rough face must not have thick layers or a film. A lossless face allows none of these "
        "keys. With an `[entrance_surface]`, only layers and the film are allowed.",
        check_by<check_entrance_face>},
    schema::Check{
        kMirrorKeys,
        "A mirror at a distance behind balls (`mirror_offset_mm` > 0) must be aluminium, an opaque layer or ideal.",
        check_by<check_ball_mirror>},
    schema::Check{kFormKeys, "A form has at most 45 terms. The degree of each term is at most 8.",
                  check_by<check_form>},
    schema::Check{kZoneKeys,
                  "Zones must cover every point of a finite part without margins exactly once. All zones together have "
                  "at most 1000 regions and 1e5 elements. The arrangement of a zone must not be `single` or `pins`.",
                  check_by<check_zones>},
    schema::Check{kEntranceKeys,
                  "An `[entrance_surface]` needs a kind or one file, and the part must be finite. Radii must not be 0.",
                  check_by<check_entrance>}};

}  // namespace

std::span<const schema::Rule> design_rules() {
  return kRules;
}

}  // namespace retrace::design
