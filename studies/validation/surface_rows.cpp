// Validation rows for materials, for the scatter of textured facets, and for published means of measured facets.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/data_directory.h"
#include "core/error.h"
#include "geometry/part/part.h"
#include "materials/io/material_library.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/roughness/io/facet_table_reader.h"
#include "studies/validation/rows.h"
#include "surface_models/gaussian_filter.h"
#include "surface_models/height_parameters.h"

namespace retrace::studies {
namespace {

void add_materials(std::vector<ValidationRow>& rows) {
  constexpr const char* kTopic = "Materials";
  for (const auto& [name, index] : {std::pair{"PMMA", 1.4925}, {"PMMA-Kasarova", 1.4914}, {"PMMA-Sultanova", 1.4906}})
    rows.push_back({.topic = kTopic,
                    .quantity = fmt::format("{}: index at 587.56 nm, relative to air", name),
                    .reference = Reference::published,
                    .expected = index,
                    .source = "the papers that data/materials.toml cites",
                    .allowed = 5e-5,
                    .why = "four decimals",
                    .compute = [name = name](auto) {
                      const auto library = materials::MaterialLibrary::shipped();
                      return materials::index_relative_to_air(library.find(name), library.air(), 587.56);
                    }});
  // Edlen's formula of 1953 for standard air, which is older than the formula that the program uses.
  const double s2 = 1.0 / (0.58756 * 0.58756);
  rows.push_back({.topic = kTopic,
                  .quantity = "air at 587.56 nm: (n - 1) times 1e6",
                  .reference = Reference::independent,
                  .expected = 1e-2 * (6432.8 + 2949810.0 / (146.0 - s2) + 25540.0 / (41.0 - s2)),
                  .source = "formula of Edlen 1953",
                  .allowed = 0.05,
                  .why = "retrace uses newer measurements",
                  .compute = [](auto) {
                    const auto library = materials::MaterialLibrary::shipped();
                    return 1e6 * (materials::refractive_index(library.air().dispersion, 587.56) - 1.0);
                  }});
  for (const auto& [wavelength_nm, n, k] : {std::array{401.43, 0.45683, 4.7236}, std::array{502.30, 0.76990, 5.9264},
                                            std::array{588.13, 1.1354, 6.8566}, std::array{700.15, 1.6945, 7.9618}})
    for (const bool is_real : {true, false})
      rows.push_back({.topic = kTopic,
                      .quantity = fmt::format("aluminium at {} nm: {}", wavelength_nm, is_real ? "n" : "k"),
                      .reference = Reference::independent,
                      .expected = is_real ? n : k,
                      .source = "table of refractiveindex.info, from Rakic et al. 1998",
                      .allowed = 2e-4 * (is_real ? n : k),
                      .why = "five digits, rounded parameters",
                      .compute = [=, wavelength_nm = wavelength_nm](auto) {
                        const auto library = materials::MaterialLibrary::shipped();
                        const auto index =
                            materials::complex_index(library.find_metal("aluminium").model, wavelength_nm);
                        return is_real ? index.real() : index.imag();
                      }});
}

void add_facets(std::vector<ValidationRow>& rows) {
  constexpr const char* kTopic = "Measured facets";
  struct Means {
    const char* process;
    double roughness_sa_nm, waviness_sa_nm;
  };
  // For the waviness of the lens, the text of the thesis gives 62.4, which is the mean of the printed means 33.4, 99.4
  // and 54.3.
  for (const auto& [process, roughness_nm, waviness_nm] :
       {Means{"pin", 2.7, 13.2}, {"die", 9.5, 32.9}, {"lens", 9.2, 62.3}, {"uspic", 19.7, 29.9}})
    for (const bool is_roughness : {true, false})
      rows.push_back(
          {.topic = kTopic,
           .quantity = fmt::format("{}: mean Sa of the {}", process, is_roughness ? "roughness" : "waviness"),
           .unit = "nm",
           .reference = Reference::published,
           .expected = is_roughness ? roughness_nm : waviness_nm,
           .source = "Milliken 2017, Tables 3.1 to 3.4",
           .allowed = 0.05,
           .why = "printed to 0.1",
           .compute = [=, process = process](auto) {
             for (const FacetGroup& group : read_facet_table(data_directory() / "facet_quality_2017.csv"))
               if (group.name == process) return is_roughness ? group.roughness_sa_nm : group.waviness_sa_nm;
             throw InputError(fmt::format("facet_quality_2017.csv: must have the process {}", process));
           }});
  for (const bool is_mean : {true, false})
    rows.push_back({.topic = kTopic,
                    .quantity = fmt::format("ten prism facets: {} of Sa", is_mean ? "mean" : "standard deviation"),
                    .unit = "nm",
                    .reference = Reference::published,
                    .expected = is_mean ? 147.07 : 41.37,
                    .source = "Hamilton et al. 2017, Table 2",
                    .allowed = 5e-3,
                    .why = "printed to 0.01",
                    .compute = [is_mean](auto) {
                      std::vector<double> sa_nm;
                      for (const FacetGroup& facet : read_facet_table(data_directory() / "rtp_facets_2017.csv"))
                        sa_nm.push_back(facet.roughness_sa_nm);
                      const surface_models::Summary summary = surface_models::summarise(sa_nm);
                      return is_mean ? summary.mean : summary.standard_deviation;
                    }});
}

/// Returns the percentage of light that one reflection scatters. It is computed from the light that an element returns
/// after several reflections.
/// \param reflections number of reflections: 3 for a cube corner, 2 for a prism
double scattered_percent(const geometry::Element& element, double sq_nm, double wavelength_nm, double reflections,
                         const Cancellation* cancel) {
  geometry::PartSpec spec;
  spec.element = element;
  spec.array.arrangement = geometry::Arrangement::single;
  spec.thickness_mm = 1.0;
  const geometry::Part part = geometry::build_part(spec);
  raytrace::Optics optics;
  optics.index = 1.4917;
  optics.lossless_entrance = true;
  optics.wavelength_nm = wavelength_nm;
  optics.facet_scatter = surface_models::HarveyShack({.sq_nm = sq_nm, .correlation_length_um = 20.0});
  const auto ledgers = raytrace::BeamTracer(part).trace(optics, {}, {0.5}, {}, cancel).ledgers;
  return 100.0 * (1.0 - std::pow(ledgers[0][raytrace::Account::retroreflected], 1.0 / reflections));
}

void add_scatter(std::vector<ValidationRow>& rows) {
  constexpr const char* kTopic = "Scatter and filters";
  struct Case {
    const char* name;
    geometry::Element element;
    double reflections, cos_incidence, wavelength_nm, sq_nm;
  };
  for (const Case& c : {Case{"cube corner", geometry::HexagonalCube{1.0}, 3.0, 1.0 / std::numbers::sqrt3, 550.0, 10.0},
                        Case{"cube corner", geometry::HexagonalCube{1.0}, 3.0, 1.0 / std::numbers::sqrt3, 550.0, 20.0},
                        Case{"prism", geometry::RtpElement{1.0, 1.0, 90.0}, 2.0, std::sqrt(0.5), 587.56, 30.0}}) {
    const double phase = 4.0 * std::numbers::pi * 1.4917 * c.sq_nm * c.cos_incidence / c.wavelength_nm;
    rows.push_back(
        {.topic = kTopic,
         .quantity = fmt::format(
             "{}, Sq {} nm, wavelength {} nm: fraction scattered by one reflection, 1 - exp(-(4 pi n s cos t / w)^2)",
             c.name, c.sq_nm, c.wavelength_nm),
         .unit = "%",
         .expected = -100.0 * std::expm1(-phase * phase),
         .source = "docs/theory/scatter.md; Davies 1954; Bennett and Porteus 1961",
         .allowed = 1e-6,
         .why = "1e-9 of the roughness has too short periods to scatter; 1e-10 of the light is truncated",
         .compute = [c](auto cancel) {
           return scattered_percent(c.element, c.sq_nm, c.wavelength_nm, c.reflections, cancel);
         }});
  }
  rows.push_back({.topic = kTopic,
                  .quantity = "areal Gaussian filter: transmitted amplitude of waves with the cut-off wavelength",
                  .reference = Reference::published,
                  .expected = 0.5,
                  .source = "ISO 16610-61",
                  .allowed = 1e-6,
                  .why = "weights beyond one cut-off, 1e-7 of the sum, are truncated",
                  .compute = [](auto) {
                    constexpr double kCutoffUm = 80.0;
                    surface_models::HeightMap profile{1601, 1, 0.5, 0.5, {}};
                    for (int k = -800; k <= 800; ++k)
                      profile.heights_nm.push_back(std::cos(2.0 * std::numbers::pi * 0.5 * k / kCutoffUm));
                    return surface_models::gaussian_split(profile, kCutoffUm).waviness.at(800, 0);
                  }});
}

}  // namespace

std::vector<ValidationRow> surface_validation() {
  std::vector<ValidationRow> rows;
  add_materials(rows);
  add_facets(rows);
  add_scatter(rows);
  return rows;
}

}  // namespace retrace::studies
