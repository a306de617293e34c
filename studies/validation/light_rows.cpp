// Validation rows for light in prisms and cube corners. They use the exact engine, because it has no noise.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/angle.h"
#include "geometry/part/part.h"
#include "materials/fresnel.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/observers/far_field.h"
#include "studies/validation/closed_forms.h"
#include "studies/validation/rows.h"

namespace retrace::studies {
namespace {

using namespace geometry;
using namespace raytrace;
using closed_forms::kDeg;

/// Index of PMMA with which the closed form agrees with the published study of array sizes.
constexpr double kPmma = 1.4917;
/// Aperture, in mm, of cube corners with dihedral edges of 1 mm: 2 sqrt(2/3).
constexpr double kCubeAperture = 1.6329931618554521;

constexpr const char* kClosedForms = "docs/theory/closed_forms.md, ";
constexpr const char* kPaperTable = "Hamilton et al. 2017, Table 1";
constexpr const char* kRounding = "rounding, and 1e-10 of the power that the exact engine truncates";

PartSpec finite(const Element& element, Arrangement arrangement, double length_mm, double thickness_mm) {
  PartSpec spec;
  spec.element = element;
  spec.array.arrangement = arrangement;
  spec.array.x_length_mm = spec.array.y_length_mm = length_mm;
  spec.thickness_mm = thickness_mm;
  return spec;
}

PartSpec single(const Element& element, double thickness_mm) {
  return finite(element, Arrangement::single, 0.0, thickness_mm);
}

PartSpec endless(const Element& element, Arrangement arrangement, double thickness_mm) {
  PartSpec spec = finite(element, arrangement, 0.0, thickness_mm);
  spec.array.extent = Extent::infinite;
  return spec;
}

Optics real(double index = kPmma) {
  Optics optics;
  optics.index = index;
  return optics;
}

/// Returns the optics of a part with a lossless entrance face. The facets reflect according to Fresnel's formulas.
Optics lossless(double index = kPmma) {
  Optics optics = real(index);
  optics.lossless_entrance = true;
  return optics;
}

Optics mirrors(double index = kPmma) {
  Optics optics = lossless(index);
  optics.mirror_facets = true;
  return optics;
}

struct Incidence {
  double deg = 0.0;
  double azimuth_deg = 0.0;
  double half_angle_deg = 0.5;
};

Ledger ledger_of(const PartSpec& spec, const Optics& optics, const Incidence& light, const BeamPolicy& policy,
                 const Cancellation* cancel) {
  const Part part = build_part(spec);
  return BeamTracer(part)
      .trace(optics, {Angle::from_deg(light.deg), Angle::from_deg(light.azimuth_deg)}, {light.half_angle_deg}, policy,
             cancel)
      .ledgers[0];
}

double rre_of(const PartSpec& spec, const Optics& optics, const Incidence& light, const Cancellation* cancel,
              const BeamPolicy& policy = {}) {
  return ledger_of(spec, optics, light, policy, cancel)[Account::retroreflected];
}

/// Returns the incidence above which light is lost, by bisection.
/// \pre is_lost(low) is false and is_lost(high) is true
template <class IsLost>
double knee_deg(double low, double high, const IsLost& is_lost) {
  for (int step = 0; step < 30; ++step) {
    const double middle = 0.5 * (low + high);
    (is_lost(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// Returns the incidence, across the roof edge of a single prism, above which light leaves through a facet.
double knee_of_a_prism_deg(const Cancellation* cancel) {
  const PartSpec spec = single(RtpElement{0.45, 0.45, 90.0}, 0.5);
  return knee_deg(1.0, 10.0,
                  [&](double deg) { return ledger_of(spec, real(), {deg}, {}, cancel)[Account::transmitted] > 1e-9; });
}

/// Returns the incidence, towards a dihedral edge of an infinite honeycomb, above which real facets return less light
/// than mirrors.
double knee_of_cubes_deg(double index, double cant_deg, const Cancellation* cancel) {
  const PartSpec spec = endless(HexagonalCube{1.0, {cant_deg, 180.0}}, Arrangement::honeycomb, 5.0);
  BeamPolicy policy;
  policy.cutoff = 1e-9;  // light that passes from cell to cell does not return to the source
  return knee_deg(1.0, 40.0, [&](double deg) {
    const Incidence light = {deg, 0.0, 0.01};
    return rre_of(spec, mirrors(index), light, cancel, policy) - rre_of(spec, lossless(index), light, cancel, policy) >
           1e-8;
  });
}

/// Returns the angle, in minutes of arc, between returned light and the direction to the source, as a mean weighted by
/// power. Only light that has hit the given number of interfaces counts.
double deviation_arcmin(const PartSpec& spec, std::uint32_t interfaces, const Cancellation* cancel) {
  const Part part = build_part(spec);
  double power = 0.0;
  double sum = 0.0;
  BeamTracer(part).trace(mirrors(), {}, {0.5}, {}, cancel, [&](const ReturnedBeam& beam) {
    if (beam.stokes.i < 1e-2 || beam.depth != interfaces) return;
    power += beam.stokes.i;
    sum += beam.stokes.i * std::asin(beam.direction.head<2>().norm()) / kDeg * 60.0;
  });
  return sum / power;
}

PartSpec with_errors(PartSpec spec, const AngleErrors& errors) {
  spec.angle_errors = errors;
  return spec;
}

PartSpec with_edges(PartSpec spec, const EdgeShape& edges) {
  spec.edges = edges;
  return spec;
}

constexpr double kWavelengthNm = 550.0;

/// Returns the intensity that one full cube corner returns exactly towards the source, divided by that of an
/// aberration-free mirror with the same aperture.
double on_axis_peak(const Optics& optics, const Cancellation* cancel) {
  const Part part = build_part(single(HexagonalCube{0.5}, 0.3));
  FarFieldPolicy policy;
  policy.wavelength_nm = kWavelengthNm;
  FarFieldCollector collector(part, {}, policy);
  BeamPolicy beams;
  beams.truncated_goal = 1e-6;
  beams.separate_cells = true;
  BeamTracer(part).trace(optics, {}, {0.5}, beams, cancel, [&](const ReturnedBeam& beam) { collector.add(beam); });
  const double wavelength_mm = 1e-6 * kWavelengthNm;
  return collector.finish().diffracted_per_sr(Vec3::UnitZ()) * wavelength_mm * wavelength_mm / area(part.outline);
}

/// Returns the radius of the first dark diffraction ring of a disc, in units of the wavelength divided by the diameter.
/// The disc is a polygon with 2000 corners, and the minimum is found by golden-section search.
double dark_ring(const Cancellation*) {
  const Part part = build_part(single(HexagonalCube{1.0}, 1.0));
  FarFieldPolicy policy;
  policy.wavelength_nm = kWavelengthNm;
  policy.window_rad = 0.1;
  FarFieldCollector collector(part, {}, policy);
  ReturnedBeam beam;
  beam.stokes.i = beam.transmission = 1.0;
  for (int k = 0; k < 2000; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / 2000.0;
    beam.exit_polygon_mm.push_back(0.5 * Vec2(std::cos(turn), std::sin(turn)));
  }
  beam.entry_polygon_mm = beam.exit_polygon_mm;
  beam.trail.first = CellInstance{};
  collector.add(beam);
  const FarField field = collector.finish();
  const auto intensity = [&](double ring) {
    const double x = ring * 1e-6 * kWavelengthNm;
    return field.diffracted_per_sr({x, 0.0, std::sqrt(1.0 - x * x)});
  };
  double low = 1.1;
  double high = 1.35;
  for (int step = 0; step < 40; ++step) {
    const double share = (high - low) / std::numbers::phi;
    if (intensity(high - share) < intensity(low + share))
      high = low + share;
    else
      low = high - share;
  }
  return 0.5 * (low + high);
}

/// Returns the RRE of an array in brick rows: f + (1 - f) 2 R / (1 + R), where f is the fraction of whole elements and
/// R the reflectance of a face.
double brick_rre(double full_share) {
  const double r = materials::reflectance(1.0 / kPmma, 1.0);
  return full_share + (1.0 - full_share) * 2.0 * r / (1.0 + r);
}

void add_table_1(std::vector<ValidationRow>& rows) {
  struct Printed {
    double base_mm, full, rre_percent;
  };
  // The arrays are 10 mm x 10 mm on a plate of 2 mm. Rows 1, 3, ... are shifted by half an element. Light falls along
  // the normal.
  for (const auto& [base_mm, full, rre_percent] :
       {Printed{10, 1, 99.99}, {5, 3, 76.88}, {2, 22, 88.90}, {1, 95, 95.37}, {0.5, 390, 97.68}}) {
    PartSpec spec = finite(RtpElement{base_mm, base_mm, 90.0}, Arrangement::offset, 10.0, 2.0);
    spec.array.shifted_rows = RowParity::odd;
    const std::string array = fmt::format("{} mm prisms on 10 mm x 10 mm", base_mm);
    const auto add = [&](ValidationRow row) {
      row.topic = "Arrays of prisms in brick rows";
      row.quantity = array + ": " + row.quantity;
      rows.push_back(std::move(row));
    };
    add({.quantity = "whole elements",
         .reference = Reference::published,
         .expected = full,
         .source = kPaperTable,
         .why = "a count",
         .compute = [spec](auto) { return static_cast<double>(build_part(spec).elements_full); }});
    add({.quantity = "area of the facets",
         .unit = "mm2",
         .reference = Reference::published,
         .expected = 141.42,
         .source = kPaperTable,
         .allowed = 5e-3,
         .why = "printed to 0.01",
         .compute = [spec](auto) { return build_part(spec).retro_facet_area_mm2; }});
    add({.quantity = "RRE",
         .unit = "%",
         .reference = Reference::published,
         .expected = rre_percent,
         .source = kPaperTable,
         .allowed = 0.011,
         .why = "printed to 0.01 from sampled rays: the last digit may be off by one",
         .compute = [spec](auto cancel) { return 100.0 * rre_of(spec, real(), {}, cancel); }});
    add({.quantity = "RRE",
         .unit = "%",
         .expected = 100.0 * brick_rre(full * base_mm * base_mm / 100.0),
         .source = fmt::format("{}1", kClosedForms),
         .allowed = 1e-7,
         .why = kRounding,
         .compute = [spec](auto cancel) { return 100.0 * rre_of(spec, real(), {}, cancel); }});
  }
  for (const auto& [count, full] : {std::pair{3, 8}, {5, 23}, {7, 46}, {25, 613}})
    rows.push_back({.topic = "Arrays of prisms in brick rows",
                    .quantity = fmt::format("{0} x {0} prisms of 0.451 mm: whole elements", count),
                    .reference = Reference::published,
                    .expected = static_cast<double>(full),
                    .source = "Milliken 2017, section 2.7",
                    .why = "a count",
                    .compute = [count = count](auto) {
                      return static_cast<double>(
                          build_part(finite(RtpElement{0.451, 0.451, 90.0}, Arrangement::offset, 0.451 * count, 1.0))
                              .elements_full);
                    }});
}

void add_total_reflection(std::vector<ValidationRow>& rows) {
  const auto add = [&](ValidationRow row) {
    row.topic = "Limits of total reflection";
    row.unit = "deg";
    row.allowed = 1e-5;
    row.why = "the onset, a loss of 1e-8, is found by bisection";
    rows.push_back(std::move(row));
  };
  add({.quantity = "prism, incidence across the roof edge, n = 1.4917",
       .expected = std::asin(kPmma * std::sin(0.25 * std::numbers::pi - std::asin(1.0 / kPmma))) / kDeg,
       .source = fmt::format("{}2", kClosedForms),
       .compute = knee_of_a_prism_deg});
  const double facet_rad = std::acos(1.0 / std::numbers::sqrt3);
  const auto limit_deg = [&](double index, double cant_deg) {
    return std::asin(index * std::sin(facet_rad - cant_deg * kDeg - std::asin(1.0 / index))) / kDeg;
  };
  for (const double index : {1.4607, 1.4906, 1.585})
    add({.quantity = fmt::format("cube corners at the worst azimuth, n = {}", index),
         .expected = limit_deg(index, 0.0),
         .source = fmt::format("{}4", kClosedForms),
         .compute = [index](auto cancel) { return knee_of_cubes_deg(index, 0.0, cancel); }});
  add({.quantity = "cube corners canted by 6 degrees away from the light, n = 1.5",
       .expected = limit_deg(1.5, 6.0),
       .source = fmt::format("{}7", kClosedForms),
       .compute = [](auto cancel) { return knee_of_cubes_deg(1.5, 6.0, cancel); }});
}

void add_apertures(std::vector<ValidationRow>& rows) {
  for (const bool is_honeycomb : {true, false})
    for (const auto& [deg, azimuth_deg] : {std::pair{0.0, 0.0}, {20.0, 15.0}, {40.0, 135.0}, {60.0, 270.0}}) {
      const Incidence light = {deg, azimuth_deg, 0.01};
      const PartSpec spec = is_honeycomb ? endless(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0)
                                         : endless(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0);
      rows.push_back({.topic = "Effective apertures of cube corners with mirror facets and a lossless entrance face",
                      .quantity = fmt::format("{}, incidence {} deg, azimuth {} deg: RRE",
                                              is_honeycomb ? "full cubes" : "triangles", deg, azimuth_deg),
                      .expected = is_honeycomb ? closed_forms::honeycomb_rre(deg, azimuth_deg, kPmma)
                                               : closed_forms::triangular_rre(deg, azimuth_deg, kPmma),
                      .source = fmt::format("{}3; Eckhardt 1971", kClosedForms),
                      .allowed = 1e-9,
                      .why = kRounding,
                      .compute = [=](auto cancel) { return rre_of(spec, mirrors(), light, cancel); }});
    }
}

/// Adds rows for the RRE of infinite arrays with Fresnel reflection at all faces. The expected values come from
/// independent ray tracing with many rays; most are means over azimuths.
void add_cells(std::vector<ValidationRow>& rows) {
  struct Kind {
    const char* name;
    PartSpec spec;
    std::vector<double> azimuth_deg;
    std::array<double, 10> rre;
  };
  constexpr std::array<double, 10> kIncidenceDeg = {0, 2.5, 5, 10, 15, 20, 22.5, 25, 30, 40};
  const std::array<Kind, 3> kinds = {Kind{"prisms, across the roof edge",
                                          endless(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 1.0),
                                          {0.0},
                                          {1.000, 0.899, 0.422, 0.122, 0.067, 0.057, 0.049, 0.035, 0.026, 0.019}},
                                     Kind{"full cubes, mean over azimuths",
                                          endless(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0),
                                          {3.75, 11.25, 18.75, 26.25, 33.75, 41.25, 48.75, 56.25},
                                          {1.000, 0.882, 0.843, 0.759, 0.679, 0.523, 0.371, 0.280, 0.169, 0.068}},
                                     Kind{"triangles, mean over azimuths",
                                          endless(TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0),
                                          {3.75, 11.25, 18.75, 26.25},
                                          {0.919, 0.649, 0.624, 0.630, 0.614, 0.497, 0.368, 0.282, 0.178, 0.080}}};
  for (const Kind& kind : kinds)
    for (std::size_t k = 0; k < kIncidenceDeg.size(); ++k)
      rows.push_back({.topic = "Comparison of cells: infinite arrays in PMMA, plate of 1 mm, acceptance 0.5 deg",
                      .quantity = fmt::format("{}, incidence {} deg: RRE", kind.name, kIncidenceDeg[k]),
                      .reference = Reference::independent,
                      .expected = kind.rre[k],
                      .source = "brute-force ray tracing",
                      .allowed = 5e-3,
                      .why = "sampling error of the ray tracing",
                      .compute = [spec = kind.spec, azimuths = kind.azimuth_deg, deg = kIncidenceDeg[k]](auto cancel) {
                        BeamPolicy policy;
                        policy.truncated_goal = 1e-3;
                        double sum = 0.0;
                        for (const double azimuth_deg : azimuths)
                          sum += rre_of(spec, real(), {deg, azimuth_deg}, cancel, policy);
                        return sum / static_cast<double>(azimuths.size());
                      }});
}

void add_paths_and_edges(std::vector<ValidationRow>& rows) {
  const auto add = [&](ValidationRow row) {
    row.topic = "Paths and edges of prisms at normal incidence";
    row.quantity += ": RRE";
    rows.push_back(std::move(row));
  };
  add({.quantity = "path of 2 T + b, T = 0.7 mm, b = 0.6 mm, absorption 0.3 / mm",
       .expected = std::exp(-0.3 * (2.0 * 0.7 + 0.6)),
       .source = fmt::format("{}5", kClosedForms),
       .allowed = 1e-9,
       .why = kRounding,
       .compute = [](auto cancel) {
         Optics optics = mirrors();
         optics.absorption_per_mm = 0.3;
         return rre_of(single(RtpElement{0.6, 0.4, 90.0}, 0.7), optics, {}, cancel);
       }});
  const PartSpec sharp = endless(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0);
  const double dead = std::numbers::sqrt2 * 0.02 / 0.5;
  for (const auto& [name, edges, share] : {std::tuple{"roots", EdgeShape{0.02, 0.0, 0.0}, dead},
                                           {"rims", EdgeShape{0.0, 0.0, 0.02}, dead},
                                           {"roots and rims", EdgeShape{0.02, 0.0, 0.02}, 2.0 * dead}})
    add({.quantity = fmt::format("{} rounded with 20 um, base 0.5 mm, lossless face", name),
         .expected = 1.0 - share,
         .source = fmt::format("{}6", kClosedForms),
         .allowed = 1e-8,
         .why = "light that the strips of the rounded edges return",
         .compute = [spec = with_edges(sharp, edges)](auto cancel) { return rre_of(spec, lossless(), {}, cancel); }});
  add({.quantity = "roots with a flat of 20 um, base 0.5 mm, lossless face",
       .expected = 1.0 - 0.04 * (1.0 - materials::reflectance(1.0 / kPmma, 1.0)),
       .source = fmt::format("{}6", kClosedForms),
       .allowed = 1e-9,
       .why = kRounding,
       .compute = [spec = with_edges(sharp, {0.0, 0.02, 0.0})](auto cancel) {
         return rre_of(spec, lossless(), {}, cancel);
       }});
}

void add_errors(std::vector<ValidationRow>& rows) {
  struct Case {
    const char* quantity;
    PartSpec spec;
    std::uint32_t interfaces;
    double factor;
    const char* source;
  };
  const double sixth = 4.0 / std::sqrt(6.0);
  for (const auto& [quantity, spec, interfaces, factor, source] :
       {Case{"all three dihedral angles of a cube off by 1 arcmin",
             with_errors(single(HexagonalCube{kCubeAperture}, 1.0), {{1.0, 1.0, 1.0}, {}}), 4, 2.0 * sixth,
             "Chandler, J. Opt. Soc. Am. 50, 1203 (1960)"},
        Case{"one dihedral angle of a cube off by 1 arcmin",
             with_errors(single(HexagonalCube{kCubeAperture}, 1.0), {{1.0, 0.0, 0.0}, {}}), 4, sixth,
             "Chandler, J. Opt. Soc. Am. 50, 1203 (1960)"},
        Case{"apex angle of a prism off by 1 arcmin",
             with_errors(single(RtpElement{1.0, 1.0, 90.0}, 1.0), {{1.0, 0.0, 0.0}, {}}), 3, 2.0,
             "two reflections rotate light by twice the angle between the facets"}})
    rows.push_back({.topic = "Deviation of light by angle errors, n = 1.4917",
                    .quantity = fmt::format("{}: deviation", quantity),
                    .unit = "arcmin",
                    .expected = factor * kPmma,
                    .source = source,
                    .allowed = 1e-3 * factor * kPmma,
                    .why = "the formula is of first order in the error",
                    .compute = [spec = spec, interfaces = interfaces](auto cancel) {
                      return deviation_arcmin(spec, interfaces, cancel);
                    }});
}

void add_diffraction(std::vector<ValidationRow>& rows) {
  const auto add = [&](ValidationRow row) {
    row.topic = "Diffraction";
    rows.push_back(std::move(row));
  };
  add({.quantity = "angle of the first dark ring of a disc, times diameter / wavelength",
       .expected = 1.2196699,
       .source = "Airy; Born and Wolf, 8.5.2",
       .allowed = 2e-5,
       .why = "the disc is a polygon with 2000 corners",
       .compute = dark_ring});
  add({.quantity = "full cube with mirror facets: peak relative to that of its aperture",
       .expected = 1.0,
       .source = "docs/theory/photometry.md",
       .allowed = 1e-6,
       .why = "1e-6 of the light is truncated",
       .compute = [](auto cancel) { return on_axis_peak(mirrors(), cancel); }});
  for (const double index : {1.4585, kPmma, 1.585})
    add({.quantity =
             fmt::format("full cube with total reflection, n = {}: peak relative to that of its aperture", index),
         .expected = closed_forms::total_reflection_peak(index),
         .source = "docs/theory/polarisation.md",
         .allowed = 1e-6,
         .why = "1e-6 of the light is truncated",
         .compute = [index](auto cancel) { return on_axis_peak(lossless(index), cancel); }});
}

}  // namespace

std::vector<ValidationRow> light_validation() {
  std::vector<ValidationRow> rows;
  add_table_1(rows);
  add_cells(rows);
  add_apertures(rows);
  add_total_reflection(rows);
  add_paths_and_edges(rows);
  add_errors(rows);
  add_diffraction(rows);
  return rows;
}

}  // namespace retrace::studies
