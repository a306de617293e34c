#include <algorithm>

#include "report/results/result_plots.h"
#include "studies/quantity/study_names.h"
#include "studies/tolerance/tolerance.h"

namespace retrace::report {
namespace {

constexpr std::size_t kMaxPoints = 400;
constexpr double kPercent = 100.0;

Series line_at(const std::string& label, double value) {
  return {label, {value, value}, {0.0, kPercent}, {}};
}

/// Returns the cumulative distribution of the values. If there are more values than the plot can show as separate
/// points, evenly spaced percentiles are used.
Series distribution(const std::vector<double>& ascending) {
  Series series{"parts", {}, {}, {}};
  const std::size_t points = std::min(kMaxPoints, ascending.size());
  for (std::size_t k = 0; k < points; ++k) {
    const double share = points > 1 ? static_cast<double>(k) / static_cast<double>(points - 1) : 0.5;
    series.add(compute::percentile(ascending, share), kPercent * share);
  }
  return series;
}

}  // namespace

LinePlot tolerance_plot(const studies::Study& study, const studies::ToleranceRequest& request,
                        const studies::ToleranceResult& result) {
  const studies::QuantityTolerance& quantity = result.quantities.front();
  LinePlot plot;
  plot.title = studies::shown_title(study) + ": distribution over manufactured parts";
  plot.x_label = quantity.quantity;
  plot.y_label = "Parts below (%)";
  plot.y_range = Range{0.0, kPercent};
  if (!quantity.values.empty()) plot.series.push_back(distribution(quantity.values));
  if (quantity.nominal) plot.series.push_back(line_at("nominal", *quantity.nominal));
  for (const studies::Constraint& limit : request.constraints) {
    if (limit.quantity != quantity.quantity) continue;
    if (limit.min) plot.series.push_back(line_at("minimum allowed", *limit.min));
    if (limit.max) plot.series.push_back(line_at("maximum allowed", *limit.max));
  }
  return plot;
}

}  // namespace retrace::report
