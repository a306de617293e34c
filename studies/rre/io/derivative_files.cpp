#include "studies/rre/io/derivative_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

std::string line_of(const RrePoint& point, const RreDerivative& by) {
  std::string line =
      fmt::format("{:>6}  {:>13}  {:>11}  {:>14}  {:<18}  ", point.design, shortest(point.incidence_deg),
                  shortest(point.azimuth_deg), shortest(point.acceptance_half_angle_deg), parameter_name(by.parameter));
  if (!by.left_out.empty()) return line + "left out: " + by.left_out + "\n";
  return line + fmt::format("{:>13.6g}  {:.1e}\n", by.derivative.value, by.derivative.error);
}

}  // namespace

Json derivatives_json(const std::vector<RreDerivative>& derivatives) {
  Json json = Json::object();
  for (const RreDerivative& by : derivatives) {
    Json& entry = json[std::string(parameter_name(by.parameter))];
    if (by.left_out.empty())
      entry = {{"value", by.derivative.value}, {"error", by.derivative.error}};
    else
      entry = {{"left_out", by.left_out}};
  }
  return json;
}

std::string derivative_table(const RreResult& result) {
  std::string lines;
  for (const RrePoint& point : result.points)
    for (const RreDerivative& by : point.derivatives) lines += line_of(point, by);
  if (lines.empty()) return {};
  return "\nd RRE (a fraction) per unit of the parameter\n"
         "design  incidence_deg  azimuth_deg  acceptance_deg  parameter               derivative  +-\n" +
         lines;
}

}  // namespace retrace::studies
