#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/number_format.h"
#include "design/io/design_labels.h"
#include "report/results/result_plots.h"
#include "studies/rre/rre_map.h"

namespace retrace::report {
namespace {

using studies::RreMap, studies::RreResult;

/// Number of columns and rows of the drawn square.
constexpr std::size_t kColumns = 201;

/// Returns the values of a map on a square around the centre, in percent. Outside of the disc, the values at its border
/// continue, so that colours and contour lines reach the border.
std::vector<double> values_of(const RreMap& map) {
  const double radius = map.incidence_deg.back();
  std::vector<double> values;
  values.reserve(kColumns * kColumns);
  const auto position = [&](std::size_t k) {
    return radius * ((2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(kColumns) - 1.0);
  };
  for (std::size_t row = 0; row < kColumns; ++row)
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double x = position(column);
      const double y = position(row);
      values.push_back(100.0 * map.at(std::min(radius, std::hypot(x, y)), 180.0 / std::numbers::pi * std::atan2(y, x)));
    }
  return values;
}

PolarPanel panel_of(const RreMap& map, std::string title, std::string remark) {
  PolarPanel panel;
  panel.title = std::move(title);
  panel.remark = std::move(remark);
  panel.radius_deg = map.incidence_deg.back();
  panel.columns = kColumns;
  panel.values = values_of(map);
  return panel;
}

std::string cone_text(const RreMap& map) {
  return fmt::format("acceptance {}°", shortest(map.acceptance_half_angle_deg));
}

PolarPlot empty_plot(std::string title, std::string value_label, PolarScale scale) {
  PolarPlot plot;
  plot.title = std::move(title);
  plot.value_label = std::move(value_label);
  plot.scale = scale;
  plot.has_azimuths = true;
  return plot;
}

}  // namespace

PolarPlot rre_map_plot(const RreResult& result) {
  PolarPlot plot = empty_plot("Retroreflective efficiency over incidence and azimuth", "Retroreflective efficiency (%)",
                              PolarScale::linear);
  const std::vector<std::string> names = design::design_labels(result.designs).names;
  for (const RreMap& map : studies::rre_maps(result)) {
    if (plot.panels.size() == kMaxMapPanels) break;
    plot.panels.push_back(panel_of(map, names[map.design],
                                   fmt::format("{}; mean up to {}°: {} %", cone_text(map),
                                               shortest(map.incidence_deg.back()), fixed(100.0 * map.mean(), 2))));
  }
  return plot;
}

bool rre_maps_can_be_compared(const RreResult& result) {
  return result.has_complete_maps() && result.designs.size() == 2 &&
         result.designs[0].detector.acceptance_half_angle_deg == result.designs[1].detector.acceptance_half_angle_deg;
}

PolarPlot rre_map_difference_plot(const RreResult& result) {
  const std::vector<std::string> names = design::design_labels(result.designs).names;
  PolarPlot plot = empty_plot(fmt::format("{} minus {}", names[1], names[0]), "Difference (percentage points)",
                              PolarScale::difference);
  const std::vector<RreMap> maps = studies::rre_maps(result);
  const std::size_t cones = maps.size() / 2;
  for (std::size_t k = 0; k < std::min(cones, kMaxMapPanels); ++k) {
    const RreMap map = studies::difference(maps[k], maps[k + cones]);
    plot.panels.push_back(
        panel_of(map, cone_text(map),
                 fmt::format("mean up to {}°: {}", shortest(map.incidence_deg.back()), fixed(100.0 * map.mean(), 2))));
  }
  return plot;
}

}  // namespace retrace::report
