
#include "report/results/result_plots.h"
#include "studies/compose/compose.h"
#include "studies/compose/goals.h"
#include "studies/quantity/study_names.h"

namespace retrace::report {

MixturePlot composition_plot(const studies::Study& study, const studies::ComposeRequest& request,
                             const studies::Composition& composition) {
  MixturePlot plot;
  plot.title = studies::shown_title(study);
  if (!composition.best) return plot;
  const studies::PartOfZones& part = *composition.best;
  for (const studies::Zone& zone : part.zones)
    plot.zones.push_back({studies::cell_text(study, zone.cell), zone.area_fraction});
  bool are_margins = true;
  for (const std::size_t goal : studies::goals_to_show(request, part.mixture)) {
    const studies::Quantity& quantity = studies::goal_of(study, request, goal);
    const bool is_margin = quantity.limit().has_value();
    are_margins = are_margins && is_margin;
    MixtureGoal row{quantity.label(),
                    {},
                    studies::goal_value_text(part.mixture.goals[goal], is_margin),
                    studies::is_price(part.mixture.prices.goals[goal]) ? part.mixture.prices.goals[goal] : 0.0};
    for (const studies::Zone& zone : part.zones)
      row.contributions.push_back(studies::contribution_of(zone, goal, is_margin));
    plot.goals.push_back(std::move(row));
  }
  plot.total_label = are_margins ? "margin %" : "part";
  return plot;
}

}  // namespace retrace::report
