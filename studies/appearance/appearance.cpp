#include "studies/appearance/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "core/random.h"
#include "geometry/direction.h"
#include "requests/descriptions.h"
#include "studies/appearance/colour_photometer.h"
#include "studies/appearance/light_lattice.h"
#include "studies/appearance/table_errors.h"
#include "studies/appearance/table_refinement.h"
#include "studies/appearance/view_grid.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Number of spectral intervals of the photometer that checks the table at random geometries. This check uses only the
// eye's response.
constexpr std::size_t kPartsOfProbes = 4;
// Azimuth of the test light by which back_of() distinguishes prisms from cube corners. At this azimuth, prisms and cube
// corners return light into clearly different directions.
constexpr double kAsideDeg = 30.0;
constexpr RandomKey kProbeKey{.seed = kAppearanceSeed, .stream = 2};

/// Checks that the exact engine supports the design, and that the design returns light in the same way at every point,
/// as a material does.
/// \throw InputError if one of these conditions is not met
void check_engine(const design::Design& design, PhotometrySettings request) {
  if (design.entrance)
    throw InputError(design.where(design.entrance_key()),
                     "a material returns light in the same way at every point, but the light that returns behind an "
                     "[entrance_surface] depends on the point: use retrace image --camera or photometry");
  design::require_supported(design, {.what = "retrace material",
                                     .balls = true,
                                     .solids = true,
                                     .shells = true,
                                     .wet_backs = true,
                                     .cell_spreads = false});
  request.engine = raytrace::Engine::automatic;
  const Photometer photometer(design, request, kIntervalsPerFunction);
  if (!photometer.is_exact())
    throw InputError(design.where_facets(),
                     "materials are computed only by the exact engine, which does not support this design: " +
                         text_of(photometer.why_undiffracted()));
}

/// Returns the value of ReflectionTable::back. For each axis, it is 1 if light reverses its direction component along
/// this axis, and -1 if light keeps this component. Cube corners reverse both components, prisms reverse only one. The
/// value that applies to more than half of the returned light is chosen. If neither value does, both components count
/// as reversed. Returns nothing if the computation was cancelled.
std::optional<Vec2> back_of(const design::Design& design, const MaterialRequest& request, const Cancellation* cancel) {
  const Vec3 to_source = geometry::direction_at(Angle::from_deg(request.entrance_deg), Angle::from_deg(kAsideDeg));
  const Photometer eye =
      photometer_of(design, photometry_of(request, -Vec2::Ones()), kEyeResponse, kIntervalsPerFunction);
  const auto fields = eye.far_fields(to_source, eye.make_tracer(), cancel);
  if (!fields) return std::nullopt;
  const std::array<Vec2, 3> ways = {Vec2(1.0, 1.0), Vec2(1.0, -1.0), Vec2(-1.0, 1.0)};
  std::array<double, 3> powers{};
  const auto add = [&](const Vec2& cosines, double power) {
    const auto distance = [&](const Vec2& way) { return (cosines - way.cwiseProduct(to_source.head<2>())).norm(); };
    const auto nearest = std::min_element(ways.begin(), ways.end(),
                                          [&](const Vec2& a, const Vec2& b) { return distance(a) < distance(b); });
    if (distance(*nearest) < std::sin(Angle::from_deg(request.window_deg).rad()))
      powers[static_cast<std::size_t>(nearest - ways.begin())] += power;
  };
  for (const Photometer::WeightedField& one : *fields) {
    for (const raytrace::FarFieldRay& ray : one.field.rays()) add(ray.direction.head<2>(), one.weight * ray.power);
    for (const raytrace::CoherentGroup& group : one.field.groups())
      for (const raytrace::FieldPolygon& polygon : group.polygons)
        add(polygon.cosines, one.weight * group.copies * polygon.power);
  }
  const auto most = std::max_element(powers.begin(), powers.end());
  const bool has_most_light = 2.0 * *most > powers[0] + powers[1] + powers[2];
  return has_most_light ? ways[static_cast<std::size_t>(most - powers.begin())] : ways[0];
}

/// Returns a table without directions of light.
/// \param back value of ReflectionTable::back
ReflectionTable empty_table(const MaterialRequest& request, const Vec2& back, const Photometer& eye) {
  ReflectionTable table;
  table.back = back;
  table.half_width = std::sin(Angle::from_deg(request.window_deg).rad());
  table.max_entrance = Angle::from_deg(request.entrance_deg);
  table.mirrors = eye.mirrors();
  table.columns = first_columns(request, table);
  return table;
}

/// Returns random geometries with their photometer readings. Returns nothing if the computation was cancelled.
std::optional<std::vector<AppearanceProbe>> probes_of(const design::Design& design,
                                                      const PhotometrySettings& photometry,
                                                      const ReflectionTable& table, const Cancellation* cancel) {
  std::vector<AppearanceProbe> probes;
  std::vector<PhotometerSetting> settings;
  for (std::uint32_t k = 0; k < kProbes; ++k) {
    const auto random = philox(kProbeKey, k, 0);
    const double sine = std::sin(table.max_entrance.rad()) * std::sqrt(unit_interval(random[0]));
    const Vec3 to_source =
        geometry::direction_at(Angle::from_rad(std::asin(sine)), Angle::from_deg(360.0 * unit_interval(random[1])));
    const auto view = view_at(table, to_source, random_deviation(table, random[2], random[3]));
    if (!view) continue;
    probes.push_back({view->to_source, view->to_observer, 0.0, max_r_a(table, to_source)});
    settings.push_back(setting_of(*view));
  }
  const Photometer eye = photometer_of(design, photometry, kEyeResponse, kPartsOfProbes);
  const auto readings = eye.measure(settings, nullptr, cancel);
  if (!readings) return std::nullopt;
  for (std::size_t k = 0; k < probes.size(); ++k) probes[k].r_a = (*readings)[k].r_a.front();
  return probes;
}

}  // namespace

AppearanceError appearance_error(const std::vector<AppearanceProbe>& probes, const std::vector<double>& r_a) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < probes.size(); ++k) errors.push_back(error_of(r_a[k], probes[k].r_a, probes[k].r_a_max));
  return {errors.size(), quantile(errors, 0.5), percentile_95_of(errors), quantile(errors, 1.0)};
}

AppearanceResult compute_appearance(const design::Design& design, const MaterialRequest& request, Progress* progress,
                                    const Cancellation* cancel) {
  requests::check(request);
  check_engine(design, photometry_of(request, Vec2::Ones()));
  const auto begin = std::chrono::steady_clock::now();
  AppearanceResult result;
  result.design = design;
  result.request = request;
  const std::optional<Vec2> back = back_of(design, request, cancel);
  result.complete = back.has_value();
  if (!result.complete) return result;
  const PhotometrySettings photometry = photometry_of(request, *back);
  const ColourPhotometer photometer(design, photometry);
  ReflectionTable table = empty_table(request, *back, photometer.eye());
  const LightLattice lattice(request.entrance_deg, table);
  std::vector<PlannedCell> cells;
  result.complete = refine_grid(photometer, request.error, table, cancel) &&
                    refine_cells(request, photometer, lattice, table, cells, progress, cancel);
  if (!result.complete) return result;
  std::optional<std::vector<AppearanceProbe>> probes = probes_of(design, photometry, table, cancel);
  result.complete = probes.has_value();
  if (!result.complete) return result;
  result.min_cell_deg = lattice.min_extent_deg(cells);
  result.table = std::move(table);
  result.probes = *std::move(probes);
  std::vector<double> told;
  for (const AppearanceProbe& probe : result.probes)
    told.push_back(luminous(result.table.r_a(probe.to_source, probe.to_observer).value()));
  result.error = appearance_error(result.probes, told);
  if (result.error.percentile_95 > request.error)
    result.warnings.push_back(
        {"table_error_above_target",
         fmt::format("for 95 % of random geometries, the table deviates from the photometer by up to {} %, but {} % "
                     "were requested: allow more directions of light, or reduce the maximum entrance angle",
                     fixed(100.0 * result.error.percentile_95, 1), fixed(100.0 * request.error, 1))});
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (progress != nullptr) progress->at(1.0);
  return result;
}

}  // namespace retrace::studies
