// Validation rows for laser ranging: cross sections of cube corners, velocity aberration and group index.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "design/io/design_reader.h"
#include "design/part_of_design.h"
#include "geometry/polygon.h"
#include "raytrace/observers/far_field.h"
#include "studies/ranging/cube_field.h"
#include "studies/ranging/ranging.h"
#include "studies/validation/closed_forms.h"
#include "studies/validation/rows.h"

namespace retrace::studies {
namespace {

constexpr const char* kRangingTheory = "docs/theory/ranging.md";
constexpr const char* kArnold = "Arnold and Appleby, Thermal-optical design of a geodetic satellite, abstract";
/// Wavelength of frequency-doubled Nd:YAG lasers, which are common in laser ranging, in nm.
constexpr double kGreenNm = 532.0;
/// Refractive index of fused silica at this wavelength.
constexpr double kSilica = 1.4607;
constexpr const char* kSilicaBody = "refractive_index = 1.4607";
/// Diameter of the cube corners of the satellite LAGEOS.
constexpr double kLageosMm = 38.1;
constexpr double kUradPerRad = 1e6;
constexpr double kArcsecOfUrad = 1e-6 * 3600.0 / closed_forms::kDeg;

/// Returns the design of a cube corner with a circular face.
/// \param body keys of the table [body]
/// \param further additional tables of the design
design::Design cube_of(double diameter_mm, const std::string& body, const std::string& further = {}) {
  return design::parse_design(
      fmt::format("schema = \"retrace.design/1\"\n[element]\nkind = \"round_icc\"\ndiameter_mm = {}\n[body]\n{}\n"
                  "[light]\nwavelength_nm = {}\n{}",
                  diameter_mm, body, kGreenNm, further),
      "cube.toml");
}

RangingResult ranging_of(const design::Design& design, RangingRequest request, const Cancellation* cancel) {
  request.map_points = 3;
  return RangingStudy(design, request).run(nullptr, cancel);
}

/// Returns the cross section in the direction to the source, divided by the cross section of a plane mirror with the
/// same area.
double relative_peak(const char* further, const Cancellation* cancel) {
  const RangingResult result = ranging_of(cube_of(kLageosMm, kSilicaBody, further), {}, cancel);
  return result.points.empty() ? 0.0 : result.points.front().centre.total / result.points.front().mirror_m2;
}

/// Returns the mean cross section over an annulus of directions, in m2.
double mean_on(const design::Design& design, double inner_urad, double outer_urad, const Cancellation* cancel) {
  RangingRequest request;
  request.aberration_arcsec = {inner_urad * kArcsecOfUrad, outer_urad * kArcsecOfUrad};
  const RangingResult result = ranging_of(design, request, cancel);
  return result.points.empty() ? 0.0 : result.points.front().annulus->total.mean;
}

/// Returns the cross section of a circular plane mirror in m2, in a direction at the given angle from the source. The
/// circle is approximated by a polygon with 2000 corners.
double disc_cross_section(double diameter_mm, double urad) {
  const geometry::Part part = design::part_of_design(cube_of(diameter_mm, kSilicaBody), nullptr);
  raytrace::FarFieldPolicy policy;
  policy.wavelength_nm = kGreenNm;
  raytrace::FarFieldCollector collector(part, {}, policy);
  raytrace::ReturnedBeam beam;
  beam.stokes.i = beam.transmission = 1.0;
  for (int k = 0; k < 2000; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / 2000.0;
    beam.exit_polygon_mm.push_back(0.5 * diameter_mm * geometry::Vec2(std::cos(turn), std::sin(turn)));
  }
  collector.add(beam);
  const double area_mm2 = geometry::area(beam.exit_polygon_mm);
  const CubeField field(collector.finish(), kGreenNm, area_mm2);
  const double sine = std::sin(1e-6 * urad);
  const std::vector<geometry::Vec3> directions = {{sine, 0.0, std::sqrt(1.0 - sine * sine)}};
  return returned_stokes(field.at(directions).front(), raytrace::kUnpolarised).i;
}

constexpr const char* kIdeal = "[idealisation]\nfacets = \"mirror\"\nentrance = \"lossless\"\n";
constexpr const char* kLossless = "[idealisation]\nentrance = \"lossless\"\n";

}  // namespace

std::vector<ValidationRow> ranging_validation() {
  std::vector<ValidationRow> rows;
  const auto add = [&rows](ValidationRow row) {
    row.topic = "Laser ranging";
    if (row.source.empty()) row.source = kRangingTheory;
    rows.push_back(std::move(row));
  };
  add({.quantity = "cube with mirrors: cross section relative to 4 pi A^2 / w^2",
       .expected = 1.0,
       .allowed = 1e-6,
       .why = "1e-8 of the light is truncated",
       .compute = [](auto cancel) { return relative_peak(kIdeal, cancel); }});
  add({.quantity = "cube with total reflection, n = 1.4607: the same ratio",
       .expected = closed_forms::total_reflection_peak(kSilica),
       .source = "docs/theory/polarisation.md",
       .allowed = 1e-6,
       .why = "1e-8 of the light is truncated",
       .compute = [](auto cancel) { return relative_peak(kLossless, cancel); }});
  const double area_m2 = 0.25 * std::numbers::pi * std::pow(1e-3 * kLageosMm, 2.0);
  const double peak_m2 = 4.0 * std::numbers::pi * std::pow(area_m2 / (1e-9 * kGreenNm), 2.0);
  for (const double urad : {5.0, 10.0, 20.0}) {
    const double x = std::numbers::pi * 1e-3 * kLageosMm * 1e-6 * urad / (1e-9 * kGreenNm);
    add({.quantity = fmt::format("round mirror of 38.1 mm at {} microrad: Airy pattern", urad),
         .unit = "10^6 m2",
         .expected = 1e-6 * peak_m2 * std::pow(2.0 * std::cyl_bessel_j(1.0, x) / x, 2.0),
         .source = "Born and Wolf, Principles of Optics, 8.5.2",
         .allowed = 1e-5 * 1e-6 * peak_m2,
         .why = "the circle is a polygon with 2000 corners",
         .compute = [urad](auto) { return 1e-6 * disc_cross_section(kLageosMm, urad); }});
  }
  add({.quantity = "uncoated cube of 25.4 mm without errors: mean over 32 to 40 microrad",
       .unit = "10^6 m2",
       .reference = Reference::published,
       .expected = 0.5,
       .source = kArnold,
       .allowed = 0.1,
       .why = "\"about 0.5\"; no wavelength and no index are given",
       .compute = [](auto cancel) {
         return 1e-6 * mean_on(cube_of(25.4, "material = \"fused-silica\""), 32.0, 40.0, cancel);
       }});
  add({.quantity = "LAGEOS, orbit at 5,900 km: largest velocity aberration",
       .unit = "microrad",
       .reference = Reference::published,
       .expected = 40.0,
       .source = kArnold,
       .allowed = 2.5,
       .why = "rounded; the rotation of the Earth is neglected",
       .compute = [](auto) { return kUradPerRad * aberration_of_orbit(5900.0, 20.0).outer_rad; }});
  return rows;
}

}  // namespace retrace::studies
