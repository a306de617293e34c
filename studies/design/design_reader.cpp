#include "studies/design/design_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/schema/reader.h"
#include "geometry/io/base_rows.h"
#include "geometry/lattice.h"
#include "studies/design/ball_reader.h"
#include "studies/design/base_reader.h"
#include "studies/design/design_document.h"
#include "studies/design/design_format.h"
#include "studies/design/part_reader.h"
#include "studies/design/spectrum_reader.h"
#include "studies/design/texture_reader.h"

namespace retrace::studies {
namespace fs = std::filesystem;
namespace {

using geometry::Extent;
using geometry::PartSpec;
using schema::Document;

/// A list of two lengths or places. \param what they are, for messages
std::array<double, 2> pair_of(const Document& document, std::string_view key, std::string_view what) {
  const std::vector<double> given = document.numbers(key);
  if (given.size() != 2)
    document.fail(key,
                  fmt::format("must be a list of two{}, got {}", what,
                              document.is_list(key) ? fmt::format("a list of {}", given.size()) : shortest(given[0])));
  return {given[0], given[1]};
}

Plate read_plate(const Document& document) {
  return {pair_of(document, "part.plate_mm", " lengths, along x and y"), document.number("body.thickness_mm")};
}

PartMesh read_mesh(const Document& document) {
  return {document.text("part.mesh"), document.file("part.mesh"), document.flag("part.allow_open"),
          document.number_if("body.thickness_mm")};
}

/// The picture of the array.
std::optional<ArrayMask> read_mask(const Document& document, const PartSpec& part) {
  constexpr std::string_view key = "array.mask";
  if (!document.has(key)) return std::nullopt;
  if (part.base) document.fail(key, "not allowed together with [base]");
  return ArrayMask{document.text(key), document.file(key), document.number("array.mask_threshold")};
}

/// Planes of single facets. What else turns or shapes all facets alike has no place beside them.
std::optional<FacetPlanesFile> read_facet_planes(const Document& document, const PartSpec& part) {
  constexpr std::string_view key = "part.facets";
  if (!document.has(key)) return std::nullopt;
  if (part.extent == Extent::infinite) document.fail(key, "only allowed for finite arrays");
  if (part.base) document.fail(key, "not allowed together with [base]");
  if (!(part.angle_errors == geometry::AngleErrors{}) || part.random_tilts.sigma_arcmin > 0.0)
    document.fail(key, "not allowed together with errors of angle, which its planes hold");
  return FacetPlanesFile{document.text(key), document.file(key)};
}

/// The plate covers all rims.
double read_thickness(const Document& document, const PartSpec& part) {
  constexpr std::string_view key = "body.thickness_mm";
  const double given_mm = document.number(key);
  const double top_mm = geometry::element_top_mm(part.element, part.angle_errors);
  const double least_mm = top_mm > 0.0 ? top_mm + 1e-6 : 0.0;
  if (given_mm < least_mm)
    document.fail(key, fmt::format("must be >= {} to cover rims that errors of angle or cant lift to {}, got {}",
                                   shortest(least_mm), shortest(top_mm), shortest(given_mm)));
  return given_mm;
}

ElementArray read_elements(const Document& document) {
  ElementArray array;
  array.part = read_part(document);
  array.mask = read_mask(document, array.part);
  array.facet_planes = read_facet_planes(document, array.part);
  check_base(document, array.part);
  array.part.thickness_mm = read_thickness(document, array.part);
  return array;
}

Shape read_shape(const Document& document) {
  if (document.has("part.plate_mm")) return read_plate(document);
  if (document.has("part.mesh")) return read_mesh(document);
  if (document.text("element.kind") == "ball") return read_balls(document);
  return read_elements(document);
}

/// A number, or pairs over the wavelength.
void read_absorption(const Document& document, Design& design) {
  constexpr std::string_view key = "body.absorption_per_mm";
  if (!document.is_list(key)) {
    design.substance.absorption_per_mm = document.number_if(key);
    return;
  }
  std::vector<SpectralAbsorption>& curve = design.substance.absorption_by_wavelength;
  for (const std::vector<double>& pair : document.rows(key)) {
    if (!curve.empty() && !(pair[0] > curve.back().wavelength_nm))
      document.fail(key, fmt::format("wavelengths must ascend, got {} after {}", shortest(pair[0]),
                                     shortest(curve.back().wavelength_nm)));
    curve.push_back({pair[0], pair[1]});
  }
  if (curve.size() < 2) document.fail(key, "must be a number or a list of two or more pairs, got a list of one");
}

void read_body(const Document& document, Design& design) {
  design.substance.material = document.text("body.material");
  if (design.substance.material.empty())
    document.fail("body.material", "must name a material, such as \"PMMA\", got \"\"");
  design.substance.refractive_index = document.number_if("body.refractive_index");
  read_absorption(document, design);
  design.substance.back_index = document.number("body.back_index");
  design.surface.aluminised_facets = document.text("body.facet_coating") == "aluminium";
}

/// A bowl behind balls is nothing but its mirror.
void check_ball_mirror(const Document& document, const Design& design) {
  if (!design.balls() || design.balls()->mirror_offset_mm == 0.0) return;
  if (design.surface.aluminised_facets || design.idealisation.mirror_facets) return;
  document.fail("element.mirror_offset_mm",
                "needs a mirror: give body.facet_coating = \"aluminium\", or idealisation.facets = \"mirror\"");
}

constexpr std::string_view kPolarisation = "light.polarisation";

/// `[i, q, u, v]` in the unit of i.
raytrace::Stokes read_stokes(const Document& document) {
  const std::vector<double> given = document.numbers(kPolarisation);
  const raytrace::Stokes stokes{1.0, given[1] / given[0], given[2] / given[0], given[3] / given[0]};
  constexpr double rounding = 1e-12;
  const double degree2 = stokes.q * stokes.q + stokes.u * stokes.u + stokes.v * stokes.v;
  if (!(given[0] > 0.0 && degree2 <= 1.0 + rounding))
    document.fail(kPolarisation,
                  fmt::format("must be [i, q, u, v] with i > 0 and q^2 + u^2 + v^2 <= i^2, got [{}, {}, {}, {}]",
                              shortest(given[0]), shortest(given[1]), shortest(given[2]), shortest(given[3])));
  return stokes;
}

raytrace::Stokes read_polarisation(const Document& document) {
  if (document.is_list(kPolarisation)) return read_stokes(document);
  const std::string word = document.text(kPolarisation);
  if (word == "right_circular") return {1.0, 0.0, 0.0, 1.0};
  if (word == "left_circular") return {1.0, 0.0, 0.0, -1.0};
  if (word != "linear") return raytrace::kUnpolarised;
  const double angle = Angle::from_deg(document.number("light.polarisation_angle_deg")).rad();
  return {1.0, std::cos(2.0 * angle), std::sin(2.0 * angle), 0.0};
}

void read_light_and_detector(const Document& document, Design& design) {
  if (auto spectrum = read_spectrum(document))
    design.light.colour = *std::move(spectrum);
  else
    design.light.colour = document.number("light.wavelength_nm");
  design.light.polarisation = read_polarisation(document);
  std::vector<double> angles_deg = document.numbers("detector.acceptance_half_angle_deg");
  std::sort(angles_deg.begin(), angles_deg.end());
  angles_deg.erase(std::unique(angles_deg.begin(), angles_deg.end()), angles_deg.end());
  design.detector.acceptance_half_angle_deg = angles_deg;
}

/// The face through which light enters; none without such a table.
std::optional<FrontFile> read_front(const Document& document, const Design& design) {
  if (!document.has("front")) return std::nullopt;
  const bool is_mesh = document.has("front.mesh");
  const std::string_view key = is_mesh ? "front.mesh" : "front.turned";
  if (!document.has(key)) document.fail(key, "missing, must name the file of a turned part, or front.mesh an STL file");
  FrontFile front;
  front.is_mesh = is_mesh;
  front.file = document.file(key);
  front.name = document.text(key);
  front.mesh_bottom = is_mesh && document.text("front.mesh_side") == "bottom";
  if (document.has("front.centre_mm")) front.centre_mm = pair_of(document, "front.centre_mm", ", x and y");
  if (design.is_endless()) document.fail(key, "not allowed for extent = \"infinite\": give lengths");
  return front;
}

/// What a document says, without the files that it names.
Design resolved(std::shared_ptr<const Document> given) {
  const Document& document = *given;
  Design design;
  design.source = document.source();
  design.title = document.text_if("title");
  design.shape = read_shape(document);
  if (!design.balls()) design.surface.texture = read_texture(document);
  read_body(document, design);
  read_light_and_detector(document, design);
  design.idealisation = {document.text("idealisation.facets") == "mirror",
                         document.text("idealisation.entrance") == "lossless"};
  check_ball_mirror(document, design);
  design.front = read_front(document, design);
  design.document = std::move(given);
  return design;
}

}  // namespace

std::vector<fs::path> Design::files() const {
  return document ? document->files() : std::vector<fs::path>();
}

void Design::set_where(const std::string& key, InputLocation place) {
  auto changed = document ? std::make_shared<Document>(*document) : std::make_shared<Document>(design_format().root);
  changed->set(key, {}, std::move(place));
  document = std::move(changed);
}

InputLocation Design::where(std::string_view key) const {
  return document ? document->where(key) : InputLocation{source, 0, std::string(key)};
}

InputLocation Design::where_texture() const {
  for (const std::string_view key : {"surface.height_map", "surface.model", "surface.roughness_sq_nm"})
    if (document && document->has(key)) return where(key);
  return where("surface.waviness_sq_nm");
}

std::string_view Design::front_key() const {
  return front && front->is_mesh ? "front.mesh" : "front.turned";
}

const ArrayMask* Design::mask() const {
  return elements() != nullptr && elements()->mask ? &*elements()->mask : nullptr;
}

const FacetPlanesFile* Design::facet_planes() const {
  return elements() != nullptr && elements()->facet_planes ? &*elements()->facet_planes : nullptr;
}

double Design::thickness_mm() const {
  return std::visit(
      Overloaded{[](const ElementArray& array) { return array.part.thickness_mm; },
                 [](const PartMesh& mesh) { return mesh.thickness_mm.value_or(0.0); },
                 [](const Plate& plate) { return plate.thickness_mm; }, [](const raytrace::BallLayer&) { return 0.0; }},
      shape);
}

void Design::require_no_balls() const {
  if (balls()) throw InputError(where("element.kind"), "balls are taken by retrace rre, photometry and inspect alone");
}

void Design::require_elements(const std::string& what) const {
  require_no_balls();
  if (elements()) return;
  throw InputError(where(mesh() ? "part.mesh" : "part.plate_mm"),
                   fmt::format("{} takes no {}, only [element] and [array]", what, mesh() ? "mesh" : "plate"));
}

void Design::require_plane_front(const std::string& what) const {
  if (front) throw InputError(where(front_key()), what + " takes no [front], only a plane entrance face");
}

void Design::require_no_base(const std::string& what) const {
  if (elements() && part().base)
    throw InputError(where(geometry::base_shape_key(*part().base)),
                     what + " takes no [base], only elements on a plane");
}

Design parse_design(std::string_view text, const std::string& source_name, std::span<const std::string> overrides) {
  return resolved(std::make_shared<const Document>(
      schema::read_document(design_format(), text, source_name, kShortTomlBytes, overrides)));
}

Design with(const Design& design, std::span<const std::string> overrides) {
  const bool is_of_file = design.document && !design.document->origin().text.empty();
  if (!is_of_file) return parse_design(design_text(design), design.source, overrides);
  Design changed =
      resolved(std::make_shared<const Document>(schema::with(design_format(), *design.document, overrides)));
  changed.source = design.source;
  return changed;
}

/// The order in which stores of studies have the files of a design: it is part of what a study is. New keys come
/// behind.
constexpr std::array<std::string_view, 7> kFilesOfStores = {
    "part.mesh", "array.mask", "surface.height_map", "part.facets", "light.spectrum", "front.turned", "front.mesh"};

std::vector<fs::path> files_named(std::string_view text, const std::string& source_name,
                                  std::span<const std::string> overrides) {
  const Document document = schema::unchecked_names(design_format(), text, source_name, kShortTomlBytes, overrides);
  const std::vector<fs::path> all = document.files();
  std::vector<fs::path> files;
  const auto add = [&](const fs::path& file) {
    if (std::ranges::count(all, file) > std::ranges::count(files, file)) files.push_back(file);
  };
  for (const std::string_view key : kFilesOfStores)
    if (!document.text_if(key).empty()) add(document.file(key));
  for (const fs::path& file : all) add(file);
  return files;
}

std::string read_toml_text(const fs::path& file) {
  return file == "-" ? read_standard_input(kShortTomlBytes) : read_file(file, kShortTomlBytes);
}

Design read_design(const fs::path& file, std::span<const std::string> overrides) {
  if (file != "-") return parse_design(read_toml_text(file), file.string(), overrides);
  Design design = parse_design(read_toml_text(file), "standard input", overrides);
  design.source = file.string();
  return design;
}

}  // namespace retrace::studies
