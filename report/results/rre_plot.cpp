#include "design/io/design_labels.h"
#include "report/results/result_plots.h"
#include "studies/rre/rre.h"

namespace retrace::report {

LinePlot rre_plot(const studies::RreResult& result) {
  const design::DesignLabels labels = design::design_labels(result.designs);
  std::vector<EfficiencyPoint> points;
  for (const studies::RrePoint& p : result.points) {
    points.push_back(
        {labels.names[p.design], p.incidence_deg, p.azimuth_deg, p.acceptance_half_angle_deg, p.rre, p.std_error});
    if (!labels.values.empty()) points.back().design_value = labels.values[p.design];
  }
  return rre_plot(points, labels.key);
}

}  // namespace retrace::report
