#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/turning/turn.h"

namespace retrace::report {
namespace {

std::string title_of(const studies::TurningResult& r) {
  return r.part.title.empty() ? r.file : r.part.title;
}

}  // namespace

LinePlot turning_acceleration_plot(const studies::TurningResult& r) {
  LinePlot plot;
  const bool is_fast = !r.servo_csv.empty();
  plot.title = fmt::format("{}: acceleration of {}", title_of(r), is_fast ? "the servo" : "Z");
  plot.x_label = "time (s)";
  plot.y_label = "acceleration (mm/s²)";
  Series series;
  for (const auto& s : r.stretch.z) series.add(s.time_s, s.acceleration_mm_per_s2);
  plot.series = {series};
  return plot;
}

LinePlot turning_profile_plot(const studies::TurningResult& r) {
  LinePlot plot;
  plot.title = fmt::format("{}: machined surface across a few cuts", title_of(r));
  plot.x_label = "x (mm)";
  plot.y_label = "deviation from the design (nm)";
  Series series;
  for (const geometry::Vec2& p : r.stretch.profile) series.add(p.x(), p.y());
  plot.series = {series};
  return plot;
}

ImagePlot turning_maps(const studies::TurningResult& r) {
  const auto& inspection = r.check.inspection;
  const std::size_t n = inspection.columns;
  const double pixel = inspection.map_width_mm / static_cast<double>(n);
  std::vector<double> height(n * n, 0.0);
  double low = 1e300;
  for (std::size_t i = 0; i < n * n; ++i) {
    if (std::isnan(inspection.map_nm[i])) continue;
    const double x = pixel * (static_cast<double>(i % n) + 0.5) - 0.5 * inspection.map_width_mm;
    const double y = 0.5 * inspection.map_width_mm - pixel * (static_cast<double>(i / n) + 0.5);
    height[i] = 1e3 * r.part.surface.height_mm(x, y);
    low = std::min(low, height[i]);
  }
  std::vector<double> left(n * n, 0.0);
  for (std::size_t i = 0; i < n * n; ++i) {
    const bool is_outside = std::isnan(inspection.map_nm[i]);
    height[i] = is_outside ? 0.0 : height[i] - low;
    left[i] = is_outside ? 0.0 : std::abs(inspection.map_nm[i]);
  }
  ImagePlot plot;
  plot.title = title_of(r);
  plot.remarks = {fmt::format("form error {} nm, scallops {} nm", fixed(inspection.form_error_nm, 2),
                              fixed(inspection.scallop_nm, 2))};
  plot.panels = {
      {"surface", "height (µm)", n, n, height, inspection.map_width_mm, "mm", 0.0, false},
      {"error of the machined surface", "|deviation| (nm)", n, n, left, inspection.map_width_mm, "mm", 0.0, false}};
  return plot;
}

}  // namespace retrace::report
