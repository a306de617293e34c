#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/length_units.h"
#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/closed_loop/verification.h"

namespace retrace::report {

SurfacePlot error_map_plot(const studies::ErrorMap& map) {
  constexpr double kNmPerUm = kNmPerMm / kUmPerMm;
  double low_nm = 0.0;
  double high_nm = 0.0;
  for (const double value : map.field.height_nm) {
    if (!std::isfinite(value)) continue;
    low_nm = std::min(low_nm, value);
    high_nm = std::max(high_nm, value);
  }
  const double largest_nm = std::max(-low_nm, high_nm);
  const double limit_nm = next_round_number(std::max(1e-3, std::min(largest_nm, map.colour_range_nm)));
  const bool in_um = limit_nm >= kNmPerUm;
  const double unit_nm = in_um ? kNmPerUm : 1.0;
  const char* const unit = in_um ? "µm" : "nm";

  GridPanel panel;
  panel.value_label = fmt::format("height above the facets ({})", unit);
  panel.columns = map.field.columns;
  panel.rows = map.field.rows;
  panel.x_size_um = kUmPerMm * map.field.size_mm.x();
  panel.y_size_um = kUmPerMm * map.field.size_mm.y();
  panel.values = map.field.height_nm;
  for (double& value : panel.values) value /= unit_nm;
  panel.deviation_limit = limit_nm / unit_nm;
  panel.lower_left_um = {kUmPerMm * map.field.low_mm.x(), kUmPerMm * map.field.low_mm.y()};
  panel.x_name = "x_w";
  panel.y_name = "y_w";

  SurfacePlot plot;
  plot.title = "Material that the programs leave above the facets";
  const auto text = [&](double nm) { return fmt::format("{:.3g} {}", nm / unit_nm, unit); };
  plot.remarks.push_back(fmt::format("heights from {} to {}; colours from -{} to {}{}; grey: flat areas", text(low_nm),
                                     text(high_nm), text(limit_nm), text(limit_nm),
                                     largest_nm > limit_nm ? ", larger deviations have the colour of the end" : ""));
  plot.panels.emplace_back(std::move(panel));
  return plot;
}

}  // namespace retrace::report
