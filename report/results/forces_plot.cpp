#include "report/results/result_plots.h"
#include "studies/forces/forces_study.h"

namespace retrace::report {

LinePlot forces_plot(const studies::ForcesResult& result) {
  LinePlot plot =
      forces_plot(ForcesOfCut{result.request.configuration, result.cut.depth_of_cut_um, result.cut.width_mm});
  for (const fabrication::ForceSample& s : result.profile) {
    plot.series[0].add(s.time_s, s.fx_n);
    plot.series[1].add(s.time_s, s.fy_n);
    plot.series[2].add(s.time_s, s.fz_n);
  }
  return plot;
}

}  // namespace retrace::report
