#include "report/forces_plot.h"

#include <fmt/format.h>

#include "core/number_format.h"

namespace retrace::report {

LinePlot forces_plot(const studies::ForcesResult& result) {
  LinePlot plot;
  plot.title = fmt::format("Cutting forces, {} cut of {} µm over {} mm", result.request.configuration,
                           shortest(result.cut.depth_of_cut_um), shortest(result.cut.width_mm));
  plot.x_label = "time (s)";
  plot.y_label = "force on the tool (N)";
  plot.series = {{"Fx", {}, {}, {}}, {"Fy", {}, {}, {}}, {"Fz", {}, {}, {}}};
  for (const fabrication::ForceSample& s : result.profile) {
    const double forces[] = {s.fx_n, s.fy_n, s.fz_n};
    for (std::size_t k = 0; k < 3; ++k) {
      plot.series[k].x.push_back(s.time_s);
      plot.series[k].y.push_back(forces[k]);
    }
  }
  return plot;
}

}  // namespace retrace::report
