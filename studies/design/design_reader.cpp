#include "studies/design/design_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/atomic_file.h"
#include "core/io/toml_node.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "geometry/lattice.h"
#include "studies/design/array_checks.h"
#include "studies/design/ball_reader.h"
#include "studies/design/base_reader.h"
#include "studies/design/design_keys.h"
#include "studies/design/edge_reader.h"
#include "studies/design/front_reader.h"
#include "studies/design/scratch_reader.h"
#include "studies/design/spectrum_reader.h"
#include "studies/design/table_reader.h"
#include "studies/design/texture_reader.h"

namespace retrace::studies {
namespace fs = std::filesystem;
namespace {

using geometry::Arrangement;
using geometry::Extent;
using geometry::PartialElements;
using geometry::PartSpec;
using geometry::RowParity;

enum class Polarisation { unpolarised, linear, right_circular, left_circular };
enum class Kind { rtp, hexagonal_icc, triangular_icc, ball };

constexpr std::string_view kSchema = "retrace.design/1";
constexpr std::array kKinds = {Choice<Kind>{"rtp", Kind::rtp}, Choice<Kind>{"hexagonal_icc", Kind::hexagonal_icc},
                               Choice<Kind>{"triangular_icc", Kind::triangular_icc},
                               Choice<Kind>{"ball", Kind::ball}};  // which ball_reader reads

/// The first of each is the default.
constexpr std::array kRtpArrangements = {
    Choice<Arrangement>{"aligned", Arrangement::aligned}, Choice<Arrangement>{"offset", Arrangement::offset},
    Choice<Arrangement>{"checker", Arrangement::checker}, Choice<Arrangement>{"single", Arrangement::single}};
constexpr std::string_view kPins = "pins";
constexpr std::array kHexagonalArrangements = {Choice<Arrangement>{"honeycomb", Arrangement::honeycomb},
                                               Choice<Arrangement>{kPins, Arrangement::honeycomb},
                                               Choice<Arrangement>{"single", Arrangement::single}};
constexpr std::array kTriangularArrangements = {Choice<Arrangement>{"triangular", Arrangement::triangular},
                                                Choice<Arrangement>{"single", Arrangement::single}};
constexpr std::array kExtents = {Choice<Extent>{"finite", Extent::finite},
                                 Choice<Extent>{"infinite", Extent::infinite}};
constexpr std::array kRowParities = {Choice<RowParity>{"even", RowParity::even},
                                     Choice<RowParity>{"odd", RowParity::odd}};
constexpr std::array kPartialElements = {Choice<PartialElements>{"cut", PartialElements::cut},
                                         Choice<PartialElements>{"omit", PartialElements::omit}};
constexpr std::array kPolarisations = {Choice<Polarisation>{"unpolarised", Polarisation::unpolarised},
                                       Choice<Polarisation>{"linear", Polarisation::linear},
                                       Choice<Polarisation>{"right_circular", Polarisation::right_circular},
                                       Choice<Polarisation>{"left_circular", Polarisation::left_circular}};
constexpr std::array kFacetModels = {Choice<bool>{"real", false}, Choice<bool>{"mirror", true}};
constexpr std::array kEntranceModels = {Choice<bool>{"real", false}, Choice<bool>{"lossless", true}};

constexpr std::array kCoatings = {Choice<bool>{"none", false}, Choice<bool>{"aluminium", true}};

constexpr Range kApexAngle{.low = 60.0, .high = 120.0};
/// Beyond 35.26 degrees a facet can stand upright.
constexpr Range kCant{.low = 0.0, .high = 30.0};
constexpr Range kAzimuth{.low = -360.0, .high = 360.0};
constexpr Range kAngleError{.low = -300.0, .high = 300.0};
constexpr Range kBackIndex{.low = 1.0, .high = 3.0};
constexpr Range kRandomTilt{.low = 0.0, .high = 60.0};
constexpr Range kSeed{.low = 0.0, .high = 4294967295.0};
constexpr Range kOverlap{.low = 0.0, .high = 100.0, .high_included = false};
constexpr Range kRefractiveIndex{.low = 1.0};
constexpr Range kPolarisationAngle{.low = -360.0, .high = 360.0};
constexpr Range kAcceptance{.low = 0.0, .low_included = false, .high = 90.0};
/// From one nanometre to one kilometre: beyond that, differences of coordinates have too few digits.
constexpr Range kSaneSize{.low = 1e-6, .high = 1e6};
constexpr Range kGap{.low = 0.0, .high = kSaneSize.high};

/// A required length in mm.
double read_size(TableReader& table, std::string_view key) {
  table.required_number(key, kPositive);
  return table.required_number(key, kSaneSize);
}

geometry::Cant read_cant(TableReader& element) {
  geometry::Cant cant;
  cant.deg = element.number("cant_deg", kCant).value_or(0.0);
  cant.azimuth_deg = element.number("cant_azimuth_deg", kAzimuth).value_or(0.0);
  return cant;
}

geometry::Element read_element(TableReader& element, Kind kind) {
  if (kind == Kind::rtp) {
    element.refuse_unless_zero({"cant_deg", "cant_azimuth_deg"}, "only allowed for cube corners");
    element.refuse({"aperture_mm"}, "not allowed for kind = \"rtp\", which has base_mm and width_mm");
    geometry::RtpElement rtp;
    rtp.base_mm = read_size(element, "base_mm");
    rtp.width_mm = read_size(element, "width_mm");
    rtp.apex_angle_deg = element.number("apex_angle_deg", kApexAngle).value_or(rtp.apex_angle_deg);
    return rtp;
  }
  element.refuse({"base_mm", "width_mm", "apex_angle_deg"}, "only allowed for kind = \"rtp\", others have aperture_mm");
  const double aperture_mm = read_size(element, "aperture_mm");
  const geometry::Cant cant = read_cant(element);
  if (kind == Kind::hexagonal_icc) return geometry::HexagonalCube{aperture_mm, cant};
  return geometry::TriangularCube{aperture_mm, cant};
}

std::span<const Choice<Arrangement>> arrangements_of(Kind kind) {
  switch (kind) {
    case Kind::rtp:
      return kRtpArrangements;
    case Kind::hexagonal_icc:
      return kHexagonalArrangements;
    case Kind::triangular_icc:
    case Kind::ball:
      break;
  }
  return kTriangularArrangements;
}

Arrangement read_arrangement(TableReader& array, Kind kind) {
  const std::span<const Choice<Arrangement>> fitting = arrangements_of(kind);
  const std::string given = array.text("arrangement").value_or(std::string(fitting.front().name));
  for (const Kind other : {Kind::rtp, Kind::hexagonal_icc, Kind::triangular_icc}) {
    const auto is_given = [&](const Choice<Arrangement>& choice) { return choice.name == given; };
    if (std::ranges::any_of(fitting, is_given) || std::ranges::none_of(arrangements_of(other), is_given)) continue;
    std::vector<std::string_view> names;
    for (const Choice<Arrangement>& choice : fitting) names.push_back(choice.name);
    array.fail("arrangement", fmt::format("must be {} for kind = {}, got {}", alternatives(names),
                                          in_quotes(kKinds[static_cast<std::size_t>(kind)].name), in_quotes(given)));
  }
  return array.choice("arrangement", fitting).value_or(fitting.front().value);
}

/// Lengths and margins: required or allowed for finite arrays, without meaning for one cell or one element.
void read_extent(TableReader& array, PartSpec& part) {
  const bool single = part.arrangement == Arrangement::single;
  if (single || part.extent == Extent::infinite) {
    const std::string why = single ? "not allowed for arrangement = \"single\", whose extent is the element's aperture"
                                   : "not allowed for extent = \"infinite\", which is one periodic cell";
    array.refuse({"x_length_mm", "y_length_mm"}, why);
    array.refuse_unless_zero({"x_offset_mm", "y_offset_mm"}, why);
    return;
  }
  part.x_length_mm = read_size(array, "x_length_mm");
  part.y_length_mm = read_size(array, "y_length_mm");
  part.x_offset_mm = array.number("x_offset_mm", kGap).value_or(0.0);
  part.y_offset_mm = array.number("y_offset_mm", kGap).value_or(0.0);
}

void read_gaps(TableReader& array, PartSpec& part, Kind kind) {
  if (kind != Kind::rtp) array.refuse_unless_zero({"x_gap_mm", "y_gap_mm"}, "only allowed for kind = \"rtp\"");
  if (part.arrangement == Arrangement::single)
    array.refuse_unless_zero({"x_gap_mm", "y_gap_mm"}, "not allowed for arrangement = \"single\"");
  part.x_gap_mm = array.number("x_gap_mm", kGap).value_or(0.0);
  part.y_gap_mm = array.number("y_gap_mm", kGap).value_or(0.0);
}

void read_rows(TableReader& array, PartSpec& part) {
  if (part.arrangement != Arrangement::offset)
    array.refuse({"shifted_rows", "overlap_percent"}, "only allowed for arrangement = \"offset\"");
  part.shifted_rows = array.choice("shifted_rows", all(kRowParities)).value_or(part.shifted_rows);
  part.overlap_percent = array.number("overlap_percent", kOverlap).value_or(part.overlap_percent);
  part.partial_elements = array.choice("partial_elements", all(kPartialElements)).value_or(part.partial_elements);
}

void read_array(TableReader& array, PartSpec& part, Kind kind) {
  part.arrangement = read_arrangement(array, kind);
  part.is_pin_bundle = kind == Kind::hexagonal_icc && array.text("arrangement") == kPins;
  part.extent = array.choice("extent", all(kExtents)).value_or(part.extent);
  if (part.arrangement == Arrangement::single && part.extent == Extent::infinite)
    array.fail("extent", "must be \"finite\" for arrangement = \"single\", got \"infinite\"");
  read_extent(array, part);
  read_gaps(array, part, kind);
  read_rows(array, part);
}

void read_dihedral_error(TableReader& surface, PartSpec& part) {
  constexpr std::string_view key = "dihedral_error_arcmin";
  std::array<double, 3>& errors = part.angle_errors.dihedral_error_arcmin;
  if (std::holds_alternative<geometry::RtpElement>(part.element)) {
    errors[0] = surface.number(key, kAngleError).value_or(0.0);
    return;
  }
  const std::vector<double> given = surface.numbers(key, kAngleError).value_or(std::vector{0.0});
  if (given.size() != 1 && given.size() != 3)
    surface.fail(key, fmt::format("must be a number or a list of three, one for each dihedral edge, got a list of {}",
                                  given.size()));
  for (std::size_t k = 0; k < 3; ++k) errors[k] = given[given.size() == 1 ? 0 : k];
}

void read_facet_tilt(TableReader& surface, PartSpec& part) {
  constexpr std::string_view key = "facet_tilt_arcmin";
  const std::size_t facets = std::holds_alternative<geometry::RtpElement>(part.element) ? 2 : 3;
  const std::vector<double> given = surface.numbers(key, kAngleError).value_or(std::vector{0.0});
  const std::optional<std::size_t> size = surface.list_size(key);
  if (size ? *size != facets : given[0] != 0.0)
    surface.fail(key, fmt::format("must be a list of {}, one for each facet, or 0, got {}", facets,
                                  size ? fmt::format("a list of {}", *size) : shortest(given[0])));
  if (size) std::copy(given.begin(), given.end(), part.angle_errors.facet_tilt_arcmin.begin());
}

void read_random_tilts(TableReader& surface, PartSpec& part) {
  constexpr std::string_view key = "angle_error_sigma_arcmin";
  part.random_tilts.sigma_arcmin = surface.number(key, kRandomTilt).value_or(0.0);
  const double seed = surface.number("angle_error_seed", kSeed).value_or(1.0);
  if (seed != std::floor(seed))
    surface.fail("angle_error_seed", fmt::format("must be a whole number {}, got {}", kSeed.text(), shortest(seed)));
  part.random_tilts.seed = static_cast<std::uint32_t>(seed);
  if (part.random_tilts.sigma_arcmin > 0.0 && part.extent == Extent::infinite)
    surface.fail(key, "must be 0 for extent = \"infinite\", whose elements are all alike; give lengths instead");
}

/// Errors of angle must not let a facet of a canted cube stand upright.
void check_steepness(const TableReader& surface, const PartSpec& part) {
  constexpr double steepest_deg = 88.0;
  constexpr double deviations = 6.0;  // of random tilts; none in 10^8 facets goes beyond
  const double deg = geometry::steepest_facet_deg(part.element, part.angle_errors) +
                     deviations * part.random_tilts.sigma_arcmin / 60.0;
  if (deg <= steepest_deg) return;
  std::string_view key = "angle_error_sigma_arcmin";
  for (const std::string_view other : {"facet_tilt_arcmin", "dihedral_error_arcmin"})
    if (surface.has(other)) key = other;
  surface.fail(key, fmt::format("the steepest facet of the canted cube with its errors must be <= {} degrees, got {}",
                                steepest_deg, fixed(deg, 2)));
}

/// The texture of a mesh's facets: everything else about them is in the mesh.
FacetTexture read_mesh_surface(const DesignDocument& document) {
  TableReader surface(document, "surface");
  FacetTexture texture = read_texture(surface);
  const std::string why = "not allowed with [part], whose mesh has the angles and edges that it has";
  surface.refuse_unless_zero({"dihedral_error_arcmin", "facet_tilt_arcmin", "angle_error_sigma_arcmin",
                              "root_radius_um", "root_chamfer_um", "rim_radius_um", "rim_chamfer_um"},
                             why);
  surface.refuse({"edge_chords", "angle_error_seed", "scratches"}, why);
  surface.finish();
  return texture;
}

/// What the retro facets are like.
FacetTexture read_surface(const DesignDocument& document, PartSpec& part) {
  TableReader surface(document, "surface");
  FacetTexture texture = read_texture(surface);
  read_dihedral_error(surface, part);
  read_facet_tilt(surface, part);
  read_random_tilts(surface, part);
  read_edges(surface, part);
  read_scratches(document, surface, part);
  surface.finish();
  const auto* rtp = std::get_if<geometry::RtpElement>(&part.element);
  if (rtp == nullptr) {
    check_steepness(surface, part);
    return texture;
  }
  const auto& [dihedral, tilt] = part.angle_errors;
  const double apex_deg = rtp->apex_angle_deg + (dihedral[0] + tilt[0] + tilt[1]) / 60.0;
  if (!kApexAngle.contains(apex_deg))
    surface.fail(
        surface.has("dihedral_error_arcmin") ? "dihedral_error_arcmin" : "facet_tilt_arcmin",
        fmt::format("the apex angle with its errors must be {}, got {}", kApexAngle.text(), shortest(apex_deg)));
  return texture;
}

PartSpec read_part(const DesignDocument& document) {
  TableReader element(document, "element");
  TableReader array(document, "array");
  PartSpec part;
  const Kind kind = element.required_choice("kind", all(kKinds));
  element.refuse({"diameter_mm", "mirror_offset_mm", "mirror_half_angle_deg"}, "only allowed for kind = \"ball\"");
  array.refuse({"gap_mm"}, "only allowed for kind = \"ball\"");
  part.element = read_element(element, kind);
  read_array(array, part, kind);
  element.finish();
  array.skip({"mask", "mask_threshold"});
  array.finish();
  check_array(part, array, element);
  return part;
}

/// A plate in place of element and array.
PartMesh read_plate(const DesignDocument& document, TableReader& part) {
  constexpr std::string_view key = "plate_mm";
  for (const char* other : {"element", "array", "base"})
    if (const toml::node* const node = document.root().get(other))
      throw InputError(document.location(*node, other), "not allowed beside part.plate_mm, which is the whole part");
  part.refuse({"mesh", "allow_open", "facets"}, "not allowed beside plate_mm");
  const std::vector<double> size = *part.numbers(key, kSaneSize);
  if (const std::size_t given = part.list_size(key).value_or(1); given != 2)
    part.fail(key, fmt::format("must be a list of two lengths, along x and y, got {}",
                               part.list_size(key) ? fmt::format("a list of {}", given) : shortest(size[0])));
  part.finish();
  PartMesh plate;
  plate.name = fmt::format("plate {} x {} mm", shortest(size[0]), shortest(size[1]));
  plate.location = part.where(key);
  plate.plate_mm = std::array{size[0], size[1]};
  return plate;
}

/// A mesh in place of element and array; none if there is no such table.
std::optional<PartMesh> read_mesh(const DesignDocument& document) {
  const toml::node* const table = document.root().get("part");
  if (table == nullptr) return std::nullopt;
  TableReader part(document, "part");
  if (part.has("plate_mm")) return read_plate(document, part);
  if (!part.has("mesh")) {
    // With an element it is for planes of single facets.
    if (document.root().contains("element")) return std::nullopt;
    throw InputError(document.location_of_missing(table, "part.mesh"), "missing, must name an STL file");
  }
  for (const char* other : {"element", "array", "base"})
    if (const toml::node* const node = document.root().get(other))
      throw InputError(document.location(*node, other), "not allowed beside part.mesh, which is the whole part");
  part.refuse({"facets"}, "not allowed beside mesh, which has the facets that it has");
  const auto file = part.file("mesh");
  PartMesh mesh;
  mesh.name = *part.text("mesh");
  mesh.file = *file;
  mesh.location = part.where("mesh");
  if (const toml::node* const node = part.node("allow_open")) {
    if (!node->is_boolean()) part.fail("allow_open", "must be true or false, got " + shown(*node));
    mesh.allow_open = node->as_boolean()->get();
  }
  part.finish();
  return mesh;
}

/// One number, or pairs over the wavelength.
void read_absorption(TableReader& body, Design& design) {
  constexpr std::string_view key = "absorption_per_mm";
  design.absorption_location = body.where(key);
  const std::optional<std::size_t> size = body.list_size(key);
  if (!size) {
    design.absorption_per_mm = body.number(key, kNotNegative);
    return;
  }
  for (const auto& [wavelength_nm, per_mm] :
       body.number_pairs(key, "[wavelength_nm, absorption_per_mm]", kPositive, kNotNegative)) {
    std::vector<SpectralAbsorption>& curve = design.absorption_by_wavelength;
    if (!curve.empty() && !(wavelength_nm > curve.back().wavelength_nm))
      body.fail(key, fmt::format("wavelengths must ascend, got {} after {}", shortest(wavelength_nm),
                                 shortest(curve.back().wavelength_nm)));
    curve.push_back({wavelength_nm, per_mm});
  }
  if (*size < 2) body.fail(key, "must be a number or a list of two or more pairs, got a list of one");
}

void read_thickness(TableReader& body, Design& design) {
  design.part.thickness_mm = read_size(body, "thickness_mm");
  if (design.mesh) return;
  const double top_mm = geometry::element_top_mm(design.part.element, design.part.angle_errors);
  const double least_mm = top_mm > 0.0 ? top_mm + kSaneSize.low : 0.0;
  if (design.part.thickness_mm < least_mm)
    body.fail("thickness_mm", fmt::format("must be >= {} to cover rims that errors of angle or cant lift to {}, got {}",
                                          shortest(least_mm), shortest(top_mm), shortest(design.part.thickness_mm)));
}

void read_body(TableReader& body, Design& design) {
  if (design.balls) {
    body.refuse({"thickness_mm"}, "not allowed for kind = \"ball\", which has no plate");
  } else if (design.mesh && !design.mesh->plate_mm) {
    body.number("thickness_mm", kPositive);
    design.part.thickness_mm = body.number("thickness_mm", kSaneSize).value_or(0.0);
  } else {
    read_thickness(body, design);
  }
  design.material_location = body.where("material");
  design.material = body.text("material").value_or(design.material);
  if (design.material.empty()) body.fail("material", "must name a material, such as \"PMMA\", got \"\"");
  design.refractive_index = body.number("refractive_index", kRefractiveIndex);
  read_absorption(body, design);
  design.back_index = body.number("back_index", kBackIndex).value_or(design.back_index);
  design.aluminised_facets = body.choice("facet_coating", all(kCoatings)).value_or(false);
  body.finish();
}

/// A bowl behind balls is nothing but its mirror.
void check_ball_mirror(const DesignDocument& document, const Design& design) {
  if (!design.balls || design.balls->mirror_offset_mm == 0.0) return;
  if (design.aluminised_facets || design.idealisation.mirror_facets) return;
  TableReader(document, "element")
      .fail("mirror_offset_mm",
            "needs a mirror: give body.facet_coating = \"aluminium\", or idealisation.facets = \"mirror\"");
}

/// `[i, q, u, v]` in the unit of i.
raytrace::Stokes read_stokes(TableReader& light, std::string_view key, std::size_t size) {
  if (size != 4) light.fail(key, fmt::format("must be a list of four Stokes parameters, got a list of {}", size));
  const std::vector<double> given = *light.numbers(key, Range{});
  const raytrace::Stokes stokes{1.0, given[1] / given[0], given[2] / given[0], given[3] / given[0]};
  constexpr double rounding = 1e-12;
  const double degree2 = stokes.q * stokes.q + stokes.u * stokes.u + stokes.v * stokes.v;
  if (!(given[0] > 0.0 && degree2 <= 1.0 + rounding))
    light.fail(key, fmt::format("must be [i, q, u, v] with i > 0 and q^2 + u^2 + v^2 <= i^2, got [{}, {}, {}, {}]",
                                shortest(given[0]), shortest(given[1]), shortest(given[2]), shortest(given[3])));
  return stokes;
}

raytrace::Stokes read_polarisation(TableReader& light) {
  constexpr std::string_view key = "polarisation";
  const std::optional<std::size_t> list_size = light.list_size(key);
  const Polarisation kind = list_size ? Polarisation::unpolarised
                                      : light.choice(key, all(kPolarisations), " or a list of four Stokes parameters")
                                            .value_or(Polarisation::unpolarised);
  if (kind != Polarisation::linear)
    light.refuse({"polarisation_angle_deg"}, "only allowed for polarisation = \"linear\"");
  if (list_size) return read_stokes(light, key, *list_size);
  switch (kind) {
    case Polarisation::unpolarised:
      break;
    case Polarisation::linear: {
      const double angle =
          Angle::from_deg(light.number("polarisation_angle_deg", kPolarisationAngle).value_or(0.0)).rad();
      return {1.0, std::cos(2.0 * angle), std::sin(2.0 * angle), 0.0};
    }
    case Polarisation::right_circular:
      return {1.0, 0.0, 0.0, 1.0};
    case Polarisation::left_circular:
      return {1.0, 0.0, 0.0, -1.0};
  }
  return raytrace::kUnpolarised;
}

void read_light_and_detector(const DesignDocument& document, Design& design) {
  TableReader light(document, "light");
  design.spectrum = read_spectrum(light);
  design.wavelength_nm = light.number("wavelength_nm", kPositive).value_or(design.wavelength_nm);
  design.wavelength_location = light.where("wavelength_nm");
  design.polarisation = read_polarisation(light);
  light.finish();
  TableReader detector(document, "detector");
  std::vector<double> angles_deg =
      detector.numbers("acceptance_half_angle_deg", kAcceptance).value_or(design.acceptance_half_angle_deg);
  detector.finish();
  std::sort(angles_deg.begin(), angles_deg.end());
  angles_deg.erase(std::unique(angles_deg.begin(), angles_deg.end()), angles_deg.end());
  design.acceptance_half_angle_deg = angles_deg;
}

void read_idealisation(const DesignDocument& document, Design& design) {
  TableReader idealisation(document, "idealisation");
  design.idealisation.mirror_facets = idealisation.choice("facets", all(kFacetModels)).value_or(false);
  design.idealisation.lossless_entrance = idealisation.choice("entrance", all(kEntranceModels)).value_or(false);
  idealisation.finish();
}

/// Before anything else: a file of another format must not be blamed for its keys.
void check_schema(TableReader& top) {
  const std::optional<std::string> schema = top.text("schema");
  if (schema && *schema != kSchema)
    top.fail("schema", fmt::format("must be {}, got {}", in_quotes(kSchema), in_quotes(*schema)));
}

/// The picture of the array; the keys of the array itself are read by read_array().
std::optional<ArrayMask> read_mask(const DesignDocument& document, const PartSpec& part) {
  constexpr Range threshold{.low = 0.0, .low_included = false, .high = 1.0};
  TableReader array(document, "array");
  const auto file = array.file("mask");
  if (!file) {
    array.refuse({"mask_threshold"}, "only allowed with mask");
    return std::nullopt;
  }
  if (!std::holds_alternative<geometry::RtpElement>(part.element))
    array.fail("mask", "only allowed for kind = \"rtp\"");
  if (part.extent == Extent::infinite || part.arrangement == Arrangement::single)
    array.fail("mask", "only allowed for finite arrays that are not \"single\"");
  ArrayMask mask;
  mask.name = *array.text("mask");
  mask.file = *file;
  mask.threshold = array.number("mask_threshold", threshold).value_or(mask.threshold);
  mask.location = array.where("mask");
  return mask;
}

/// Planes of single facets. What else turns or shapes all facets alike has no place beside them.
std::optional<FacetPlanesFile> read_facet_planes(const DesignDocument& document, const PartSpec& part) {
  TableReader table(document, "part");
  const auto file = table.file("facets");
  std::optional<FacetPlanesFile> planes;
  if (file) planes = FacetPlanesFile{*table.text("facets"), *file, table.where("facets")};
  table.finish();
  if (!planes) return planes;
  if (part.extent == Extent::infinite) table.fail("facets", "only allowed for finite arrays");
  if (part.base) table.fail("facets", "not allowed together with [base]");
  if (!(part.angle_errors == geometry::AngleErrors{}) || part.random_tilts.sigma_arcmin > 0.0)
    table.fail("facets", "not allowed together with errors of angle, which its planes hold");
  return planes;
}

}  // namespace

void Design::require_no_balls() const {
  if (balls) throw InputError(balls_location, "balls are taken by retrace rre, photometry and inspect alone");
}

void Design::require_elements(const std::string& what) const {
  require_no_balls();
  if (mesh)
    throw InputError(mesh->location, fmt::format("{} takes no {}, only [element] and [array]", what,
                                                 mesh->plate_mm ? "plate" : "mesh"));
}

void Design::require_plane_front(const std::string& what) const {
  if (front) throw InputError(front->location, what + " takes no [front], only a plane entrance face");
}

void Design::require_no_base(const std::string& what) const {
  if (part.base) throw InputError(base_location, what + " takes no [base], only elements on a plane");
}

namespace {

/// All of a design but the files that it names.
Design read_keys(const DesignDocument& document, const std::string& source_name) {
  TableReader top(document, "");
  check_schema(top);
  check_keys(document);
  Design design;
  design.source = source_name;
  design.title = top.text("title").value_or("");
  design.mesh = read_mesh(document);
  if (design.mesh) {
    design.texture = read_mesh_surface(document);
  } else if (has_balls(document)) {
    if (const toml::node* const base = document.root().get("base"))
      throw InputError(document.location(*base, "base"), "not allowed for kind = \"ball\"");
    design.balls = read_balls(document);
    design.balls_location = TableReader(document, "element").where("kind");
  } else {
    design.part = read_part(document);
    design.base_location = read_base(document, design.part);
    design.mask = read_mask(document, design.part);
    design.texture = read_surface(document, design.part);
    design.facet_planes = read_facet_planes(document, design.part);
    check_base_of(design);
  }
  TableReader body(document, "body");
  read_body(body, design);
  read_light_and_detector(document, design);
  read_idealisation(document, design);
  check_ball_mirror(document, design);
  design.front = read_front(document, design);
  return design;
}

}  // namespace

Design parse_design(std::string_view text, const std::string& source_name, std::span<const std::string> overrides) {
  const DesignDocument document(text, source_name, overrides);
  Design design = read_keys(document, source_name);
  design.files = document.files();
  return design;
}

std::vector<fs::path> files_named(std::string_view text, const std::string& source_name,
                                  std::span<const std::string> overrides) {
  std::optional<DesignDocument> document;
  try {
    document.emplace(text, source_name, overrides);
    read_keys(*document, source_name);
  } catch (const Error&) {  // told by whoever reads it as a design
  }
  return document ? document->files() : std::vector<fs::path>();
}

std::string read_toml_text(const fs::path& file) {
  return file == "-" ? read_standard_input(DesignDocument::max_bytes) : read_file(file, DesignDocument::max_bytes);
}

Design read_design(const fs::path& file, std::span<const std::string> overrides) {
  if (file != "-") return parse_design(read_toml_text(file), file.string(), overrides);
  Design design = parse_design(read_toml_text(file), "standard input", overrides);
  design.source = file.string();
  return design;
}

}  // namespace retrace::studies
