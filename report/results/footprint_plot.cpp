#include <algorithm>

#include "design/io/design_json.h"
#include "design/io/design_labels.h"
#include "report/results/result_plots.h"
#include "studies/rre/rre.h"

namespace retrace::report {
namespace {

using studies::EntranceFace, studies::ReturnedLight, studies::RreResult;

/// \param name name of the design; empty if all panels are of the same design
MapPanel panel_of(const RreResult& result, const ReturnedLight& light, const std::string& name) {
  const EntranceFace& face = result.faces[light.at.design];
  const bool has_azimuths =
      std::ranges::any_of(result.returned, [](const ReturnedLight& other) { return other.at.azimuth_deg != 0.0; });
  MapPanel panel = footprint_panel({.design = name,
                                    .incidence_deg = light.at.incidence_deg,
                                    .azimuth_deg = has_azimuths ? std::optional(light.at.azimuth_deg) : std::nullopt,
                                    .active_fraction = light.footprint->active_fraction(),
                                    .rre_contribution = light.footprint->rre_contribution()});
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
  plot.title =
      result.designs.size() == 1 ? design::short_name(result.designs.front()) : "Active regions of the entrance face";
  plot.axis_unit = "mm";
  plot.value_label = "Efficiency (%)";
  plot.hatched_label = "dead";
  plot.full_value = 100.0;
  const bool are_several = result.designs.size() > 1;
  const std::vector<std::string> names = design::design_labels(result.designs).names;
  for (const ReturnedLight& light : result.returned)
    if (light.footprint && plot.panels.size() < kMaxFootprintPanels)
      plot.panels.push_back(panel_of(result, light, are_several ? names[light.at.design] : std::string()));
  return plot;
}

}  // namespace retrace::report
