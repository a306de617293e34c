#include <fmt/format.h>

#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/forces/forces_study.h"

namespace retrace::report {

LinePlot forces_plot(const studies::ForcesResult& result) {
  LinePlot plot;
  plot.title = fmt::format("Cutting forces, {} cut of {} µm over {} mm", result.request.configuration,
                           shortest(result.cut.depth_of_cut_um), shortest(result.cut.width_mm));
  plot.x_label = "time (s)";
  plot.y_label = "force on the tool (N)";
  plot.series = {{"Fx", {}, {}, {}}, {"Fy", {}, {}, {}}, {"Fz", {}, {}, {}}};
  for (const fabrication::ForceSample& s : result.profile) {
    plot.series[0].add(s.time_s, s.fx_n);
    plot.series[1].add(s.time_s, s.fy_n);
    plot.series[2].add(s.time_s, s.fz_n);
  }
  return plot;
}

}  // namespace retrace::report
