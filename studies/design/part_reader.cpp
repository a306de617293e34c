#include "studies/design/part_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/number_format.h"
#include "geometry/lattice.h"
#include "studies/design/array_checks.h"
#include "studies/design/base_reader.h"
#include "studies/design/edge_reader.h"
#include "studies/design/scratch_reader.h"

namespace retrace::studies {
namespace {

using geometry::Arrangement;
using geometry::Extent;
using geometry::PartSpec;
using schema::Document;

constexpr NumberRange kApexAngle{.low = 60.0, .high = 120.0};

geometry::Element element_of(const Document& document) {
  const std::string kind = document.text("element.kind");
  if (kind == "rtp")
    return geometry::RtpElement{document.number("element.base_mm"), document.number("element.width_mm"),
                                document.number("element.apex_angle_deg")};
  const double aperture_mm = document.number("element.aperture_mm");
  const geometry::Cant cant{document.number("element.cant_deg"), document.number("element.cant_azimuth_deg")};
  if (kind == "hexagonal_icc") return geometry::HexagonalCube{aperture_mm, cant};
  return geometry::TriangularCube{aperture_mm, cant};
}

Arrangement arrangement_of(const std::string& word) {
  constexpr std::array<std::string_view, 6> words = {"single",  "aligned",   "offset",
                                                     "checker", "honeycomb", "triangular"};
  if (word == "pins") return Arrangement::honeycomb;
  return static_cast<Arrangement>(std::ranges::find(words, word) - words.begin());
}

void read_array(const Document& document, PartSpec& part) {
  const std::string arrangement = document.text("array.arrangement");
  part.arrangement = arrangement_of(arrangement);
  part.is_pin_bundle = arrangement == "pins";
  part.extent = document.text("array.extent") == "infinite" ? Extent::infinite : Extent::finite;
  const auto read = [&](std::string_view key, double& value) { value = document.number_if(key).value_or(value); };
  read("array.x_length_mm", part.x_length_mm);
  read("array.y_length_mm", part.y_length_mm);
  read("array.x_offset_mm", part.x_offset_mm);
  read("array.y_offset_mm", part.y_offset_mm);
  read("array.x_gap_mm", part.x_gap_mm);
  read("array.y_gap_mm", part.y_gap_mm);
  part.partial_elements = document.choice<geometry::PartialElements>("array.partial_elements");
  if (part.arrangement != Arrangement::offset) return;
  part.shifted_rows = document.choice<geometry::RowParity>("array.shifted_rows");
  part.overlap_percent = document.number("array.overlap_percent");
}

void read_dihedral_error(const Document& document, PartSpec& part) {
  constexpr std::string_view key = "surface.dihedral_error_arcmin";
  std::array<double, 3>& errors = part.angle_errors.dihedral_error_arcmin;
  const std::vector<double> given = document.numbers(key);
  if (std::holds_alternative<geometry::RtpElement>(part.element)) {
    errors[0] = given[0];
    return;
  }
  if (given.size() != 1 && given.size() != 3)
    document.fail(key, fmt::format("must be a number or a list of three, one for each dihedral edge, got a list of {}",
                                   given.size()));
  for (std::size_t k = 0; k < 3; ++k) errors[k] = given[given.size() == 1 ? 0 : k];
}

void read_facet_tilt(const Document& document, PartSpec& part) {
  constexpr std::string_view key = "surface.facet_tilt_arcmin";
  const std::size_t facets = std::holds_alternative<geometry::RtpElement>(part.element) ? 2 : 3;
  const std::vector<double> given = document.numbers(key);
  const bool is_list = document.is_list(key);
  if (is_list ? given.size() != facets : given[0] != 0.0)
    document.fail(key, fmt::format("must be a list of {}, one for each facet, or 0, got {}", facets,
                                   is_list ? fmt::format("a list of {}", given.size()) : shortest(given[0])));
  if (is_list) std::copy(given.begin(), given.end(), part.angle_errors.facet_tilt_arcmin.begin());
}

void read_random_tilts(const Document& document, PartSpec& part) {
  constexpr std::string_view key = "surface.angle_error_sigma_arcmin";
  part.random_tilts.sigma_arcmin = document.number(key);
  part.random_tilts.seed = static_cast<std::uint32_t>(document.number("surface.angle_error_seed"));
  if (part.random_tilts.sigma_arcmin > 0.0 && part.extent == Extent::infinite)
    document.fail(key, "must be 0 for extent = \"infinite\", whose elements are all alike; give lengths instead");
}

/// The key of an error of angle that was given, to be blamed for all of them.
std::string_view blamed_error(const Document& document, std::string_view otherwise) {
  for (const std::string_view key : {"surface.dihedral_error_arcmin", "surface.facet_tilt_arcmin"})
    if (document.has(key)) return key;
  return otherwise;
}

/// Errors of angle must not let a facet of a canted cube stand upright.
void check_steepness(const Document& document, const PartSpec& part) {
  constexpr double steepest_deg = 88.0;
  constexpr double deviations = 6.0;  // of random tilts; none in 10^8 facets goes beyond
  const double deg = geometry::steepest_facet_deg(part.element, part.angle_errors) +
                     deviations * part.random_tilts.sigma_arcmin / 60.0;
  if (deg > steepest_deg)
    document.fail(blamed_error(document, "surface.angle_error_sigma_arcmin"),
                  fmt::format("the steepest facet of the canted cube with its errors must be <= {} degrees, got {}",
                              steepest_deg, fixed(deg, 2)));
}

void check_angles(const Document& document, const PartSpec& part) {
  const auto* rtp = std::get_if<geometry::RtpElement>(&part.element);
  if (rtp == nullptr) return check_steepness(document, part);
  const auto& [dihedral, tilt] = part.angle_errors;
  const double apex_deg = rtp->apex_angle_deg + (dihedral[0] + tilt[0] + tilt[1]) / 60.0;
  if (!kApexAngle.contains(apex_deg))
    document.fail(
        blamed_error(document, "surface.facet_tilt_arcmin"),
        fmt::format("the apex angle with its errors must be {}, got {}", kApexAngle.text(), shortest(apex_deg)));
}

}  // namespace

PartSpec read_part(const Document& document) {
  PartSpec part;
  part.element = element_of(document);
  read_array(document, part);
  check_array(part, document);
  read_base(document, part);
  read_dihedral_error(document, part);
  read_facet_tilt(document, part);
  read_random_tilts(document, part);
  read_edges(document, part);
  read_scratches(document, part);
  check_angles(document, part);
  return part;
}

}  // namespace retrace::studies
