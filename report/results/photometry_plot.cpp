#include <fmt/format.h>

#include "core/number_format.h"
#include "design/io/design_json.h"
#include "report/results/result_plots.h"
#include "studies/photometry/photometry.h"

namespace retrace::report {
namespace {

PolarMark::Kind mark_of(studies::Verdict verdict) {
  switch (verdict) {
    case studies::Verdict::pass:
    case studies::Verdict::unconfirmed: return PolarMark::Kind::holds;
    case studies::Verdict::undetermined: return PolarMark::Kind::open;
    case studies::Verdict::fail: return PolarMark::Kind::fails;
  }
  return PolarMark::Kind::open;
}

}  // namespace

PolarPlot far_field_plot(const studies::PhotometryResult& result) {
  PolarPlot plot;
  plot.title = fmt::format("{}: far field and test points", design::short_name(result.design));
  plot.value_label = "R_A (cd/lx/m²)";
  for (const studies::FarFieldMap& map : result.maps) {
    PolarPanel panel;
    panel.title = fmt::format("V {}°, H {}°", shortest(map.v_deg), shortest(map.h_deg));
    panel.radius_deg = map.half_width_deg;
    panel.columns = map.columns;
    panel.values = map.r_a;
    for (const studies::PhotometricPoint& p : result.points)
      if (p.v_deg == map.v_deg && p.test_point.h_deg == map.h_deg)
        panel.marks.push_back({0.0, p.test_point.observation_deg,
                               fmt::format("{} mcd/lx", fixed(p.r_i_mcd_per_lx, p.r_i_mcd_per_lx < 10.0 ? 1 : 0)),
                               mark_of(p.verdict())});
    plot.panels.push_back(std::move(panel));
  }
  return plot;
}

LinePlot observation_plot(const studies::PhotometryResult& result) {
  LinePlot plot;
  plot.title = fmt::format("{}: coefficient of retroreflection", design::short_name(result.design));
  plot.x_label = "Observation angle α (°)";
  plot.y_label = "R_A (cd/lx/m²)";
  plot.y_is_logarithmic = true;
  for (const studies::ObservationCurve& curve : result.curves) {
    plot.series.push_back(
        {fmt::format("entrance angle β = {}°", shortest(curve.entrance_deg)), curve.observation_deg, curve.r_a, {}});
  }
  return plot;
}

}  // namespace retrace::report
