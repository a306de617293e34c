#include "report/plot_contents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/number_format.h"

namespace retrace::report {
namespace {

/// Distinct values of each parameter of the points. One parameter with several values becomes the x axis, and the
/// others distinguish the curves.
struct Variation {
  std::set<std::string_view> designs;
  std::set<double> incidences;
  std::set<double> azimuths;
  std::set<double> cones;

  explicit Variation(const std::vector<EfficiencyPoint>& points) {
    for (const EfficiencyPoint& p : points) {
      designs.insert(p.design);
      incidences.insert(p.incidence_deg);
      azimuths.insert(p.azimuth_deg);
      cones.insert(p.acceptance_half_angle_deg);
    }
  }
};

enum class Axis { incidence, azimuth, cone };

Axis choose_axis(const Variation& v) {
  if (v.incidences.size() > 1) return Axis::incidence;
  if (v.azimuths.size() > 1) return Axis::azimuth;
  return v.cones.size() > 1 ? Axis::cone : Axis::incidence;
}

double coordinate(const EfficiencyPoint& p, Axis axis) {
  if (axis == Axis::azimuth) return p.azimuth_deg;
  return axis == Axis::cone ? p.acceptance_half_angle_deg : p.incidence_deg;
}

/// Parameter that differs between curves.
enum class Parameter { none, design, azimuth, cone };

/// Returns a text with the values of the parameters that differ between curves.
/// \param without parameter that the text does not contain
std::string label(const EfficiencyPoint& p, const Variation& v, Axis axis, Parameter without = Parameter::none) {
  std::vector<std::string> parts;
  if (v.designs.size() > 1 && without != Parameter::design) parts.push_back(p.design);
  if (v.azimuths.size() > 1 && axis != Axis::azimuth && without != Parameter::azimuth)
    parts.push_back(fmt::format("azimuth {}°", shortest(p.azimuth_deg)));
  if (v.cones.size() > 1 && axis != Axis::cone && without != Parameter::cone)
    parts.push_back(fmt::format("acceptance {}°", shortest(p.acceptance_half_angle_deg)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Parameters that are equal for all points of one curve.
using CurveKey = std::tuple<std::string_view, double, double, double>;

CurveKey curve_of(const EfficiencyPoint& p, Axis axis) {
  return {p.design, axis == Axis::incidence ? 0.0 : p.incidence_deg, axis == Axis::azimuth ? 0.0 : p.azimuth_deg,
          axis == Axis::cone ? 0.0 : p.acceptance_half_angle_deg};
}

constexpr std::string_view kEfficiencyLabel = "Retroreflective efficiency (%)";

/// Maximum number of groups of curves that dashes distinguish.
constexpr std::size_t kMaxDashes = 4;

double value_of(const EfficiencyPoint& p, Parameter parameter) {
  if (parameter == Parameter::azimuth) return p.azimuth_deg;
  return parameter == Parameter::cone ? p.acceptance_half_angle_deg : p.design_value.value_or(0.0);
}

/// Returns the parameters with numeric values that differ between curves.
std::vector<Parameter> numeric_parameters(const std::vector<EfficiencyPoint>& points, const Variation& v, Axis axis) {
  std::vector<Parameter> parameters;
  if (v.azimuths.size() > 1 && axis != Axis::azimuth) parameters.push_back(Parameter::azimuth);
  if (v.cones.size() > 1 && axis != Axis::cone) parameters.push_back(Parameter::cone);
  const auto has_value = [](const EfficiencyPoint& p) { return p.design_value.has_value(); };
  if (v.designs.size() > 1 && std::ranges::all_of(points, has_value)) parameters.push_back(Parameter::design);
  return parameters;
}

/// Curves that differ only in one parameter, for each of these groups.
struct Groups {
  Parameter parameter = Parameter::none;
  std::vector<std::string> labels;       ///< values of all other parameters
  std::vector<std::size_t> of_series;    ///< index of the group of each curve
  std::pair<double, double> range = {};  ///< range of the parameter
};

/// \param curves one point of each curve
Groups groups_by(Parameter parameter, const std::vector<const EfficiencyPoint*>& curves, const Variation& v,
                 Axis axis) {
  Groups groups;
  groups.parameter = parameter;
  groups.range = {value_of(*curves.front(), parameter), value_of(*curves.front(), parameter)};
  for (const EfficiencyPoint* curve : curves) {
    const std::string text = label(*curve, v, axis, parameter);
    const auto found = std::ranges::find(groups.labels, text);
    groups.of_series.push_back(static_cast<std::size_t>(found - groups.labels.begin()));
    if (found == groups.labels.end()) groups.labels.push_back(text);
    const double value = value_of(*curve, parameter);
    groups.range = {std::min(groups.range.first, value), std::max(groups.range.second, value)};
  }
  return groups;
}

/// Colours the curves by the value of a parameter, and distinguishes groups of curves by dashes. If there are too many
/// groups, the curves of a group have the same colour instead. Does nothing if no parameter has numeric values.
void distinguish_many(LinePlot& plot, const std::vector<EfficiencyPoint>& points,
                      const std::vector<const EfficiencyPoint*>& curves, const Variation& v, Axis axis,
                      const std::string& design_key) {
  Groups groups;
  for (const Parameter parameter : numeric_parameters(points, v, axis)) {
    Groups others = groups_by(parameter, curves, v, axis);
    if (groups.parameter == Parameter::none || others.labels.size() < groups.labels.size()) groups = std::move(others);
  }
  if (groups.parameter == Parameter::none) return;
  const bool has_scale = groups.labels.size() <= kMaxDashes;
  const bool is_azimuth = groups.parameter == Parameter::azimuth;
  if (has_scale)
    plot.scale_label = is_azimuth                            ? "Azimuth (°)"
                       : groups.parameter == Parameter::cone ? "Acceptance half angle (°)"
                                                             : design_key;
  plot.legend.emplace();
  if (groups.labels.size() > 1)
    for (std::size_t k = 0; k < groups.labels.size(); ++k) {
      std::string text = groups.labels[k];
      if (!has_scale && groups.parameter != Parameter::design)
        text += fmt::format(", {} {}° to {}°", is_azimuth ? "azimuth" : "acceptance", shortest(groups.range.first),
                            shortest(groups.range.second));
      plot.legend->push_back({std::move(text), k});
    }
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    plot.series[k].look = groups.of_series[k];
    if (has_scale) plot.series[k].scale_value = value_of(*curves[k], groups.parameter);
  }
}

}  // namespace

LinePlot rre_plot(const std::vector<EfficiencyPoint>& points, const std::string& design_key) {
  const Variation v(points);
  const Axis axis = choose_axis(v);
  LinePlot plot;
  plot.title = v.designs.size() == 1 ? fmt::format("{}: retroreflective efficiency", *v.designs.begin())
                                     : "Retroreflective efficiency";
  plot.y_label = kEfficiencyLabel;
  plot.x_label = axis == Axis::azimuth ? "Azimuth (°)"
                 : axis == Axis::cone  ? "Acceptance half angle (°)"
                                       : "Incidence angle (°)";
  // The angles may be in any order. The points of a curve are sorted by angle.
  std::vector<const EfficiencyPoint*> sorted;
  std::vector<const EfficiencyPoint*> curves;
  std::map<CurveKey, std::size_t> series_of;
  for (const EfficiencyPoint& p : points) {
    sorted.push_back(&p);
    const auto [it, is_new] = series_of.try_emplace(curve_of(p, axis), plot.series.size());
    if (!is_new) continue;
    plot.series.push_back({label(p, v, axis), {}, {}, {}});
    curves.push_back(&p);
  }
  if (curves.size() > kMaxCurvesInLegend) distinguish_many(plot, points, curves, v, axis, design_key);
  std::ranges::stable_sort(sorted, {}, [&](const EfficiencyPoint* p) { return coordinate(*p, axis); });
  for (const EfficiencyPoint* p : sorted)
    plot.series[series_of.at(curve_of(*p, axis))].add(coordinate(*p, axis), 100.0 * p->rre, 100.0 * p->std_error);
  return plot;
}

namespace {

/// Returns the label of the series to which measured facets belong. Each process has its own series. All single facets
/// from the same file are in one series.
std::string label_of(const MeasuredFacets& facets) {
  if (!facets.is_process) return fmt::format("single facets: {}", std::filesystem::path(facets.table).stem().string());
  return fmt::format("{}: waviness Sa {} nm, {} facets", facets.name, fixed(facets.waviness_sa_nm, 1), facets.facets);
}

}  // namespace

LinePlot roughness_plot(const std::string& design, const std::vector<RoughnessValue>& values) {
  LinePlot plot;
  plot.title = fmt::format("{}: retroreflective efficiency with rough facets", design);
  plot.x_label = "Roughness Sa (nm)";
  plot.y_label = kEfficiencyLabel;
  const auto measured = std::ranges::find_if(values, [](const RoughnessValue& v) { return v.measured.has_value(); });
  if (measured != values.end())
    plot.x_label +=
        fmt::format("; measured facets at a correlation length of {} µm", shortest(measured->correlation_length_um));
  std::map<std::string, std::size_t> series_of;
  for (const RoughnessValue& v : values) {
    const std::string label =
        v.measured ? label_of(*v.measured) : fmt::format("correlation length {} µm", shortest(v.correlation_length_um));
    const auto [it, is_new] = series_of.try_emplace(label, plot.series.size());
    if (is_new) plot.series.push_back({label, {}, {}, {}, !v.measured});
    plot.series[it->second].add(v.roughness_sa_nm, 100.0 * v.rre, 100.0 * v.std_error);
  }
  return plot;
}

LinePlot forces_plot(const ForcesOfCut& cut) {
  LinePlot plot;
  plot.title = fmt::format("Cutting forces, {} cut of {} µm over {} mm", cut.configuration,
                           shortest(cut.depth_of_cut_um), shortest(cut.width_mm));
  plot.x_label = "time (s)";
  plot.y_label = "force on the tool (N)";
  plot.series = {{"Fx", {}, {}, {}}, {"Fy", {}, {}, {}}, {"Fz", {}, {}, {}}};
  return plot;
}

PathPlot tool_path_plot(const ElementPath& path) {
  PathPlot plot;
  plot.title = fmt::format("{}: tool path, {}", path.job,
                           path.is_roughing  ? "roughing"
                           : path.is_layered ? "layers"
                                             : "finishing");
  plot.remarks = {
      fmt::format("one element of {}, {}; machine {}", path.elements,
                  path.is_cube_corner ? "in the plane of one of its three facets" : "in the section across its root",
                  path.machine)};
  plot.x_label = path.is_cube_corner ? "along the facet's horizontal line (mm)" : "across the root (mm)";
  plot.y_label = path.is_cube_corner ? "up the facet from the apex (mm)" : "above the root (mm)";
  plot.kinds = {{"plunge", false, {}}, {"plough", false, {}}, {"retract", false, {}}, {"to the next cut", true, {}}};
  return plot;
}

namespace {

std::string angle_text(double deg) {
  return (deg < 0.0 ? "\u2212" : "") + shortest(std::abs(deg)) + "°";
}

}  // namespace

MapPanel footprint_panel(const FootprintValues& footprint) {
  MapPanel panel;
  panel.title = "incidence " + angle_text(footprint.incidence_deg);
  if (footprint.azimuth_deg) panel.title += ", azimuth " + angle_text(*footprint.azimuth_deg);
  if (!footprint.design.empty()) {
    panel.remarks.push_back(panel.title);
    panel.title = footprint.design;
  }
  panel.remarks.push_back(fmt::format("{} % active, returns {} %", fixed(100.0 * footprint.active_fraction, 1),
                                      fixed(100.0 * footprint.rre_contribution, 1)));
  return panel;
}

}  // namespace retrace::report
