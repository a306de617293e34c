#include <fmt/format.h>

#include <algorithm>

#include "design/io/design_json.h"
#include "report/results/result_plots.h"
#include "studies/rre/rre.h"

namespace retrace::report {
namespace {

using studies::RrePoint, studies::RreResult;

/// Returns the name of a design. Designs with the same name, such as two designs from one template, are distinguished
/// by their number.
std::string name_of(const RreResult& result, std::size_t design) {
  const std::string name = design::short_name(result.designs[design]);
  const auto has_name = [&](const design::Design& other) { return design::short_name(other) == name; };
  const bool is_only_one = std::count_if(result.designs.begin(), result.designs.end(), has_name) < 2;
  return is_only_one ? name : fmt::format("{} (design {})", name, design);
}

}  // namespace

LinePlot rre_plot(const RreResult& result) {
  std::vector<std::string> names;
  for (std::size_t design = 0; design < result.designs.size(); ++design) names.push_back(name_of(result, design));
  std::vector<EfficiencyPoint> points;
  for (const RrePoint& p : result.points)
    points.push_back(
        {names[p.design], p.incidence_deg, p.azimuth_deg, p.acceptance_half_angle_deg, p.rre, p.std_error});
  return rre_plot(points);
}

}  // namespace retrace::report
