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

std::string label(const EfficiencyPoint& p, const Variation& v, Axis axis) {
  std::vector<std::string> parts;
  if (v.designs.size() > 1) parts.push_back(p.design);
  if (v.azimuths.size() > 1 && axis != Axis::azimuth)
    parts.push_back(fmt::format("azimuth {}°", shortest(p.azimuth_deg)));
  if (v.cones.size() > 1 && axis != Axis::cone)
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

}  // namespace

LinePlot rre_plot(const std::vector<EfficiencyPoint>& points) {
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
  std::map<CurveKey, std::size_t> series_of;
  for (const EfficiencyPoint& p : points) {
    sorted.push_back(&p);
    const auto [it, is_new] = series_of.try_emplace(curve_of(p, axis), plot.series.size());
    if (is_new) plot.series.push_back({label(p, v, axis), {}, {}, {}});
  }
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
