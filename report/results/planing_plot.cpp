#include <fmt/format.h>

#include <limits>

#include "report/results/result_plots.h"
#include "studies/planing/planing_study.h"

namespace retrace::report {
namespace {

constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();

std::string title_of(const studies::PlaningResult& result, const std::string& what) {
  const std::string name = result.part.title.empty() ? "Flat lens" : result.part.title;
  return fmt::format("{}: {}", name, what);
}

LinePlot plot_over_distance(const studies::PlaningResult& result, const std::string& what, const std::string& y_label) {
  LinePlot plot;
  plot.title = title_of(result, what);
  plot.x_label = result.part.mill ? "distance from the centre (mm)" : "radius (mm)";
  plot.y_label = y_label;
  return plot;
}

/// Returns the distance, in samples, from one drawn sample to the next. It is chosen such that at most 2 * kPoints
/// samples are drawn.
std::size_t stride_of(std::size_t samples) {
  constexpr std::size_t kPoints = 6000;
  return std::max<std::size_t>(1, samples / kPoints);
}

}  // namespace

LinePlot planing_profile_plot(const studies::PlaningResult& result) {
  LinePlot plot = plot_over_distance(result, "profile", "height (mm)");
  Series design{"design", {}, {}, {}};
  Series left{result.part.mill ? "machined surface" : "chords", {}, {}, {}};
  const auto& profile = result.check.profile;
  for (std::size_t k = 0; k < profile.size(); k += stride_of(profile.size())) {
    design.add(profile[k].x_mm, -profile[k].design_mm);
    left.add(profile[k].x_mm, -profile[k].machined_mm);
  }
  const auto& points = result.plan.points;
  for (std::size_t k = 0; k < points.size(); k += stride_of(points.size())) design.add(points[k].x_mm, points[k].z_mm);
  for (const std::size_t k : result.plan.chords) left.add(points[k].x_mm, points[k].z_mm);
  plot.series = {design, left};
  return plot;
}

LinePlot planing_zones_plot(const studies::PlaningResult& result) {
  LinePlot plot = plot_over_distance(result, result.part.mill ? "strokes by set" : "ends of chords", "height (mm)");
  if (!result.part.mill) {
    Series ends{"ends of chords", {}, {}, {}};
    for (const std::size_t k : result.plan.chords) ends.add(result.plan.points[k].x_mm, result.plan.points[k].z_mm);
    plot.series = {ends};
    return plot;
  }
  plot.series = {{"odd zones", {}, {}, {}}, {"even zones", {}, {}, {}}, {"inner zones", {}, {}, {}}};
  const double grid = result.part.mill->grid_mm;
  for (std::size_t k = 0; k < result.plan.cuts.size(); ++k) {
    const fabrication::ZoneCut& cut = result.plan.cuts[k];
    Series& series = plot.series[!result.plan.uses_depth_method[cut.zone] ? 2 : cut.zone % 2];
    if (k > 0 && result.plan.cuts[k - 1].zone != cut.zone) series.add(kBreak, kBreak);
    series.add(static_cast<double>(cut.x) * grid, -static_cast<double>(cut.depth) * grid);
  }
  return plot;
}

LinePlot planing_error_plot(const studies::PlaningResult& result) {
  LinePlot plot = plot_over_distance(result, "remaining material", "height above the design (mm)");
  Series error;
  const fabrication::ZoneProfile profile(result.part.lens);
  std::size_t zone = 0;
  for (const fabrication::ProfileSample& s : result.check.profile) {
    const std::size_t here = profile.zone_of(s.x_mm);
    if (here != zone) error.add(kBreak, kBreak);
    // Samples within one grid step of a vertical wall are omitted, because they may be on either side of the wall.
    if (here == zone && s.x_mm < result.part.lens.half_width_mm - result.part.mill->grid_mm)
      error.add(s.x_mm, s.design_mm - s.machined_mm);
    zone = here;
  }
  plot.series = {error};
  plot.y_range = Range{-0.2 * result.part.tolerance_mm, 1.2 * result.part.tolerance_mm};
  return plot;
}

}  // namespace retrace::report
