#include "report/rre_plot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "core/number_format.h"
#include "studies/design/design_json.h"

namespace retrace::report {
namespace {

using studies::RrePoint;
using studies::RreResult;

/// What varies in the result: one of these becomes the axis, the others tell curves apart.
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

std::string label(const RreResult& result, const RrePoint& p, const Variation& v, Axis axis) {
  std::vector<std::string> parts;
  if (v.designs.size() > 1) parts.push_back(short_name(result.designs[p.design]));
  if (v.azimuths.size() > 1 && axis != Axis::azimuth)
    parts.push_back(fmt::format("azimuth {}°", shortest(p.azimuth_deg)));
  if (v.cones.size() > 1 && axis != Axis::cone)
    parts.push_back(fmt::format("acceptance {}°", shortest(p.acceptance_half_angle_deg)));
  return fmt::format("{}", fmt::join(parts, ", "));
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
  for (const RrePoint& p : result.points) {
    const std::string name = label(result, p, v, axis);
    auto it = plot.series.begin();
    while (it != plot.series.end() && it->label != name) ++it;
    if (it == plot.series.end()) it = plot.series.insert(it, Series{name, {}, {}, {}});
    it->x.push_back(coordinate(p, axis));
    it->y.push_back(100.0 * p.rre);
    it->y_error.push_back(100.0 * p.std_error);
  }
  return plot;
}

}  // namespace retrace::report
