#include <fmt/format.h>

#include <cmath>

#include "core/number_format.h"
#include "design/io/design_json.h"
#include "design/io/design_labels.h"
#include "report/results/result_plots.h"
#include "studies/photometry/coefficient_map.h"
#include "studies/photometry/photometer.h"

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

std::string text_of_angles(const studies::CoefficientMap& map) {
  return fmt::format("rotation {}°, presentation angle {}°", shortest(map.rotation_deg),
                     shortest(map.presentation_deg));
}

/// Returns the panel for a map, without marks of test points.
/// \param factor factor by which the values of the map are multiplied
ContourPanel panel_of(const studies::CoefficientMap& map, std::string title, double factor) {
  ContourPanel panel;
  panel.title = std::move(title);
  panel.x = map.observation_deg;
  panel.y = map.entrance_deg;
  for (const double value : map.r_a) panel.values.push_back(factor * value);
  return panel;
}

/// Marks the test points that a map contains: their rotation is that of the map, and their direction of light is in the
/// plane of the map's entrance angles.
void add_marks(const studies::PhotometryResult& result, const studies::CoefficientMap& map, ContourPanel& panel) {
  constexpr double kSameAngleDeg = 1e-9;
  const auto is_in = [](const std::vector<double>& list, double value) {
    return value >= list.front() && value <= list.back();
  };
  for (const studies::PhotometricPoint& p : result.points)
    for (const double entrance_deg : {-p.v_deg, p.v_deg, -p.test_point.h_deg, p.test_point.h_deg}) {
      const studies::PhotometerSetting setting =
          studies::setting_at(entrance_deg, map.presentation_deg, map.rotation_deg);
      const bool is_in_plane = std::abs(setting.v_deg - p.v_deg) < kSameAngleDeg &&
                               std::abs(setting.h_deg - p.test_point.h_deg) < kSameAngleDeg;
      if (!is_in_plane || p.rotation_deg != map.rotation_deg || !is_in(panel.y, entrance_deg) ||
          !is_in(panel.x, p.test_point.observation_deg))
        continue;
      panel.marks.push_back({p.test_point.observation_deg, entrance_deg, mark_of(p.verdict())});
      break;
    }
}

ContourPlot empty_contour_plot(std::string title, std::string value_label, ContourScale scale) {
  ContourPlot plot;
  plot.title = std::move(title);
  plot.x_label = "Observation angle α (°)";
  plot.y_label = "Entrance angle β (°)";
  plot.value_label = std::move(value_label);
  plot.scale = scale;
  return plot;
}

}  // namespace

ContourPlot coefficient_map_plot(const studies::PhotometryResult& result) {
  const bool is_r_i = result.limits_are_r_i();
  const std::vector<std::string> names = design::design_labels(result.map_designs()).names;
  const std::string quantity = is_r_i ? "coefficient of luminous intensity" : "coefficient of retroreflection";
  ContourPlot plot = empty_contour_plot(
      names.size() == 1 ? fmt::format("{}: {}", names.front(), quantity)
                        : (is_r_i ? "Coefficient of luminous intensity" : "Coefficient of retroreflection"),
      is_r_i ? "R_I (mcd/lx)" : "R_A (cd/lx/m²)", ContourScale::decades);
  const double factor =
      is_r_i ? studies::in_mcd_per_lx(1.0, studies::PhotometricUnit::cd_per_lx_per_m2, result.request.area_cm2) : 1.0;
  bool has_marks = false;
  for (const studies::CoefficientMap& map : result.coefficient_maps) {
    if (plot.panels.size() == kMaxMapPanels) break;
    const bool is_single = names.size() == 1;
    ContourPanel panel = panel_of(map, is_single ? text_of_angles(map) : names[map.design], factor);
    if (!is_single) panel.remark = text_of_angles(map);
    if (map.design == 0) add_marks(result, map, panel);
    has_marks = has_marks || !panel.marks.empty();
    plot.panels.push_back(std::move(panel));
  }
  if (has_marks)
    plot.remark =
        "test points of the standard: circle = limit is met, square = undetermined, triangle = limit is missed";
  return plot;
}

ContourPlot coefficient_ratio_plot(const studies::PhotometryResult& result) {
  const std::vector<std::string> names = design::design_labels(result.map_designs()).names;
  ContourPlot plot = empty_contour_plot(fmt::format("{} divided by {}", names[1], names[0]),
                                        result.limits_are_r_i() ? "Ratio of R_I" : "Ratio of R_A", ContourScale::ratio);
  for (const studies::CoefficientMap& map : studies::ratio_maps(result)) {
    if (plot.panels.size() == kMaxMapPanels) break;
    plot.panels.push_back(panel_of(map, text_of_angles(map), 1.0));
  }
  return plot;
}

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
