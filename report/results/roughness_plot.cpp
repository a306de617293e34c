#include "design/io/design_json.h"
#include "report/results/result_plots.h"
#include "studies/roughness/roughness.h"

namespace retrace::report {

LinePlot roughness_plot(const studies::RoughnessResult& result) {
  std::vector<RoughnessValue> values;
  for (const studies::RoughnessPoint& p : result.points) {
    values.push_back({p.roughness_sa_nm, p.correlation_length_um, {}, p.rre, p.std_error});
    if (!p.measured) continue;
    const studies::FacetGroup& group = result.measured[*p.measured];
    values.back().measured = {group.is_process, group.name, group.table, group.facets, group.waviness_sa_nm};
  }
  return roughness_plot(design::short_name(result.design), values);
}

}  // namespace retrace::report
