// Answers about photometry: available standards, and the results of a design at the test points of a standard.
#include <nlohmann/json.hpp>
#include <set>

#include "core/data_directory.h"
#include "live/engine/answers.h"
#include "live/engine/request.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/io/standard_reader.h"
#include "studies/photometry/photometry.h"
#include "studies/photometry/standards.h"

namespace retrace::live {
namespace {

using studies::PhotometricPoint;

Json standard_json(const studies::ShippedStandard& standard, const studies::LimitTable& limits) {
  std::set<std::string> classes;
  std::set<std::string> colours;
  const auto add = [&](const studies::LimitLine& line) {
    if (line.standard != standard.table_name) return;
    classes.insert(line.classes.begin(), line.classes.end());
    if (!line.colour.empty()) colours.insert(line.colour == "clear" ? "white" : line.colour);
  };
  for (const studies::LimitRow& row : limits.rows) add(row);
  for (const studies::LimitFactor& factor : limits.factors) add(factor);
  return {{"name", standard.name},
          {"description", standard.description},
          {"conditions", standard.conditions},
          {"classes", classes},
          {"colours", colours}};
}

Json point_json(const PhotometricPoint& point) {
  return {{"observation_deg", point.test_point.observation_deg},
          {"v_deg", point.test_point.v_deg},
          {"h_deg", point.test_point.h_deg},
          {"rotation_deg", point.rotation_deg},
          {"value_mcd_per_lx", point.r_i_mcd_per_lx},
          {"std_error_mcd_per_lx", point.std_error_mcd_per_lx},
          {"limit_mcd_per_lx", point.limit_mcd_per_lx},
          {"margin", point.margin()},
          {"limit_status", studies::status_name(point.test_point.status)},
          {"verdict", studies::verdict_name(point.verdict())}};
}

}  // namespace

Json standards_json() {
  const studies::LimitTable limits = studies::read_limits(data_directory() / "photometry_limits.csv");
  Json standards = Json::array();
  for (const studies::ShippedStandard& standard : studies::shipped_standards())
    standards.push_back(standard_json(standard, limits));
  return {{"standards", std::move(standards)}};
}

Json photometry_json(const OpenedDesign& opened, const Json& request, TimeLimit& limit) {
  opened.require_tracer();
  auto asked = fields_of<PhotometryRequest>(request);
  asked.advice = false;
  studies::PhotometrySettings settings = studies::resolve(asked, opened.design().substance.is_coloured());
  settings.colour = false;
  const studies::PhotometryResult result =
      studies::PhotometryStudy(opened.design(), std::move(settings)).run(&limit, limit.cancel());
  if (!result.complete)
    throw BudgetError("the computation of these test points exceeds its time limit: use retrace photometry");
  Json points = Json::array();
  for (const PhotometricPoint& point : result.points) points.push_back(point_json(point));
  return {{"verdict", studies::verdict_name(result.verdict)},
          {"reason", result.reason.text},
          {"engine", result.engine},
          {"has_diffraction", result.has_diffraction},
          {"warnings", texts_of(result.warnings)},
          {"points", std::move(points)}};
}

}  // namespace retrace::live
