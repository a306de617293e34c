#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/design/io/design_json.h"
#include "studies/rre/rre.h"

namespace retrace::report {
namespace {

using studies::EntranceFace, studies::ReturnedLight, studies::RreResult;

std::string angle(double deg) {
  return (deg < 0.0 ? "\u2212" : "") + shortest(std::abs(deg)) + "°";
}

std::string direction_of(const RreResult& result, const ReturnedLight& light) {
  const bool has_azimuths = std::any_of(result.returned.begin(), result.returned.end(),
                                        [](const ReturnedLight& other) { return other.at.azimuth_deg != 0.0; });
  std::string text = "incidence " + angle(light.at.incidence_deg);
  if (has_azimuths) text += ", azimuth " + angle(light.at.azimuth_deg);
  return text;
}

MapPanel panel_of(const RreResult& result, const ReturnedLight& light) {
  const EntranceFace& face = result.faces[light.at.design];
  MapPanel panel;
  panel.title = direction_of(result, light);
  if (result.designs.size() > 1) {
    panel.remarks.push_back(panel.title);
    panel.title = short_name(result.designs[light.at.design]);
  }
  panel.remarks.push_back(fmt::format("{} % active, returns {} %", fixed(100.0 * light.footprint->active_share(), 1),
                                      fixed(100.0 * light.footprint->rre_shown(), 1)));
  panel.outline = face.outline_mm;
  panel.is_periodic = face.is_periodic;
  panel.lines = face.rims_mm;
  panel.fine_lines = face.roots_mm;
  for (const studies::ActiveRegion& region : light.footprint->regions)
    panel.regions.push_back({region.outline_mm, 100.0 * region.efficiency});
  return panel;
}

}  // namespace

MapPlot footprint_plot(const RreResult& result) {
  MapPlot plot;
  plot.title = result.designs.size() == 1 ? short_name(result.designs.front()) : "Active regions of the entrance face";
  plot.axis_unit = "mm";
  plot.value_label = "Efficiency (%)";
  plot.rest_label = "dead";
  plot.full_value = 100.0;
  for (const ReturnedLight& light : result.returned)
    if (light.footprint && plot.panels.size() < kMostFootprintPanels) plot.panels.push_back(panel_of(result, light));
  return plot;
}

}  // namespace retrace::report
