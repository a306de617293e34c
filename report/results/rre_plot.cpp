#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "core/number_format.h"
#include "report/results/result_plots.h"
#include "studies/design/io/design_json.h"
#include "studies/rre/rre.h"

namespace retrace::report {
namespace {

using studies::RrePoint, studies::RreResult;

/// Parameters that vary in the result. One of them becomes the axis, and the others distinguish the curves.
struct Variation {
  std::set<std::size_t> designs;
  std::set<double> incidences;
  std::set<double> azimuths;
  std::set<double> cones;

  explicit Variation(const RreResult& result) {
    for (const RrePoint& p : result.points) {
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

double coordinate(const RrePoint& p, Axis axis) {
  if (axis == Axis::azimuth) return p.azimuth_deg;
  return axis == Axis::cone ? p.acceptance_half_angle_deg : p.incidence_deg;
}

/// Returns the label of a design. Designs with the same name, such as two designs from one template, are distinguished
/// by their number.
std::string design_label(const RreResult& result, std::size_t design) {
  const std::string name = short_name(result.designs[design]);
  const auto has_name = [&](const studies::Design& other) { return short_name(other) == name; };
  const bool is_only_one = std::count_if(result.designs.begin(), result.designs.end(), has_name) < 2;
  return is_only_one ? name : fmt::format("{} (design {})", name, design);
}

std::string label(const RreResult& result, const RrePoint& p, const Variation& v, Axis axis) {
  std::vector<std::string> parts;
  if (v.designs.size() > 1) parts.push_back(design_label(result, p.design));
  if (v.azimuths.size() > 1 && axis != Axis::azimuth)
    parts.push_back(fmt::format("azimuth {}°", shortest(p.azimuth_deg)));
  if (v.cones.size() > 1 && axis != Axis::cone)
    parts.push_back(fmt::format("acceptance {}°", shortest(p.acceptance_half_angle_deg)));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Parameters that are equal for all points of one curve.
using CurveKey = std::tuple<std::size_t, double, double, double>;

CurveKey curve_of(const RrePoint& p, Axis axis) {
  return {p.design, axis == Axis::incidence ? 0.0 : p.incidence_deg, axis == Axis::azimuth ? 0.0 : p.azimuth_deg,
          axis == Axis::cone ? 0.0 : p.acceptance_half_angle_deg};
}

}  // namespace

LinePlot rre_plot(const RreResult& result) {
  const Variation v(result);
  const Axis axis = choose_axis(v);
  LinePlot plot;
  plot.title = result.designs.size() == 1 ? short_name(result.designs.front()) : "Retroreflective efficiency";
  plot.y_label = "Retroreflective efficiency (%)";
  plot.x_label = axis == Axis::azimuth ? "Azimuth (°)"
                 : axis == Axis::cone  ? "Acceptance half angle (°)"
                                       : "Incidence angle (°)";
  // The angles may be in any order. The points of a curve are sorted by angle.
  std::vector<const RrePoint*> points;
  for (const RrePoint& p : result.points) points.push_back(&p);
  std::map<CurveKey, std::size_t> series_of;
  for (const RrePoint* p : points) {
    const auto [it, is_new] = series_of.try_emplace(curve_of(*p, axis), plot.series.size());
    if (is_new) plot.series.push_back(Series{label(result, *p, v, axis), {}, {}, {}});
  }
  std::stable_sort(points.begin(), points.end(),
                   [&](const RrePoint* a, const RrePoint* b) { return coordinate(*a, axis) < coordinate(*b, axis); });
  for (const RrePoint* p : points) {
    Series& series = plot.series[series_of.at(curve_of(*p, axis))];
    series.add(coordinate(*p, axis), 100.0 * p->rre, 100.0 * p->std_error);
  }
  return plot;
}

}  // namespace retrace::report
