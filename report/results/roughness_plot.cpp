#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/design/io/design_json.h"
#include "studies/roughness/roughness.h"

namespace retrace::report {
namespace {

using studies::FacetGroup, studies::RoughnessPoint;

/// Returns the label of a group. Each process is a group of its own. Single facets are grouped by their table.
std::string label_of(const FacetGroup& group) {
  if (!group.is_process) return fmt::format("single facets: {}", std::filesystem::path(group.table).stem().string());
  return fmt::format("{}: waviness Sa {} nm, {} facets", group.name, fixed(group.waviness_sa_nm, 1), group.facets);
}

}  // namespace

LinePlot roughness_plot(const studies::RoughnessResult& result) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  LinePlot plot;
  plot.title = fmt::format("{}: what rough facets cost", short_name(result.design));
  plot.x_label = fmt::format("Roughness Sa (nm); measured facets at a correlation length of {} µm",
                             shortest(result.request.correlation_length_um.front()));
  plot.y_label = "Retroreflective efficiency (%)";
  std::map<std::string, std::size_t> series_of;
  for (const RoughnessPoint& p : result.points) {
    const std::string label = p.measured ? label_of(result.measured[*p.measured])
                                         : fmt::format("correlation length {} µm", shortest(p.correlation_length_um));
    const auto [it, is_new] = series_of.try_emplace(label, plot.series.size());
    if (is_new) plot.series.push_back(Series{label, {}, {}, {}});
    Series& series = plot.series[it->second];
    // Points without coordinates interrupt the line, so that measured facets are not connected by it.
    if (p.measured && !is_new) series.add(kNone, kNone, 0.0);
    series.add(p.roughness_sa_nm, 100.0 * p.rre, 100.0 * p.std_error);
  }
  return plot;
}

}  // namespace retrace::report
