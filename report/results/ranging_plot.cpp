#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/angle.h"
#include "core/number_format.h"
#include "design/io/design_json.h"
#include "report/results/result_plots.h"
#include "studies/ranging/ranging.h"

namespace retrace::report {
namespace {

using studies::RangingMap, studies::RangingResult;

constexpr double kMillionM2 = 1e6;

std::string ranging_title(const RangingResult& result) {
  const studies::RangingPoint& p = result.points.front();
  return fmt::format("{}, {} nm, incidence {}°, azimuth {}°", design::short_name(result.design),
                     shortest(p.index.wavelength_nm), shortest(p.incidence_deg), shortest(p.azimuth_deg));
}

/// Returns a panel with one component of the map. Pictures begin with the top row and maps with the bottom row, so the
/// order of the rows is reversed.
template <class Component>
ImagePanel ranging_panel(const RangingResult& result, const char* title, double full_value,
                         const Component& component) {
  const RangingMap& map = result.map;
  ImagePanel panel;
  panel.title = title;
  panel.value_label = "cross section (10⁶ m²)";
  panel.columns = panel.rows = map.points;
  panel.width = 2.0 * map.half_width_rad * kArcsecPerRad;
  panel.length_unit = "arcsec";
  panel.full_value = full_value;
  for (std::size_t row = map.points; row-- > 0;)
    for (std::size_t column = 0; column < map.points; ++column)
      panel.values.push_back(std::max(0.0, component(map.values[row * map.points + column])) / kMillionM2);
  const std::optional<studies::Annulus>& annulus = result.settings.annulus;
  if (annulus && annulus->outer_rad < map.half_width_rad)
    panel.circles = {annulus->inner_rad * kArcsecPerRad, annulus->outer_rad * kArcsecPerRad};
  return panel;
}

}  // namespace

ImagePlot ranging_map_plot(const RangingResult& result) {
  ImagePlot plot;
  const RangingMap& map = result.map;
  plot.title = ranging_title(result);
  plot.remarks.push_back("around the direction back to the source, as seen from the source");
  if (result.settings.annulus) plot.remarks.push_back("dashed: annulus of velocity aberration");
  double full_value = 0.0;
  for (const auto& value : map.values) full_value = std::max(full_value, value.total / kMillionM2);
  plot.panels.push_back(ranging_panel(result, "Total", full_value, [](const auto& v) { return v.total; }));
  if (!map.values.front().parallel) return plot;
  plot.panels.push_back(
      ranging_panel(result, "Polarisation as sent", full_value, [](const auto& v) { return *v.parallel; }));
  plot.panels.push_back(
      ranging_panel(result, "Orthogonal polarisation", full_value, [](const auto& v) { return *v.crossed; }));
  return plot;
}

LinePlot ranging_rings_plot(const RangingResult& result) {
  LinePlot plot;
  plot.title = ranging_title(result);
  plot.x_label = "angle from the direction to the source (arcsec)";
  plot.y_label = "cross section (10⁶ m²)";
  Series mean{"mean over the azimuth", {}, {}, {}};
  Series min{"minimum", {}, {}, {}};
  Series max{"maximum", {}, {}, {}};
  for (std::size_t k = 0; k < result.map.ring_rad.size(); ++k) {
    const double angle = result.map.ring_rad[k] * kArcsecPerRad;
    mean.add(angle, result.map.ring_m2[k].mean / kMillionM2);
    min.add(angle, result.map.ring_m2[k].min / kMillionM2);
    max.add(angle, result.map.ring_m2[k].max / kMillionM2);
  }
  plot.series = {std::move(mean), std::move(min), std::move(max)};
  if (const std::optional<studies::Annulus>& annulus = result.settings.annulus)
    plot.shaded_x = {{annulus->inner_rad * kArcsecPerRad, annulus->outer_rad * kArcsecPerRad}};
  return plot;
}

LinePlot ranging_response_plot(const RangingResult& result) {
  const studies::RangingPoint& p = result.points.front();
  LinePlot plot;
  plot.title = ranging_title(result);
  plot.x_label = "one-way range from the origin (mm)";
  plot.y_label = "response (m² per mm)";
  plot.series.push_back({fmt::format("pulse of {} ps", shortest(*result.settings.request.pulse_ps)),
                         p.response.range_mm,
                         p.response.per_mm,
                         {}});
  return plot;
}

}  // namespace retrace::report
