#include "studies/roughness/io/roughness_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "design/io/design_json.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json curve_json(const RoughnessPoint& p) {
  return {{"correlation_length_um", p.correlation_length_um},
          {"sa_nm", p.roughness_sa_nm},
          {"sq_nm", gaussian_sq_nm(p.roughness_sa_nm)},
          {"rre", p.rre},
          {"std_error", p.std_error}};
}

Json measured_json(const RoughnessPoint& p, const FacetGroup& group) {
  return {{"table", group.table},
          {"name", group.name},
          {"is_process", group.is_process},
          {"facets", group.facets},
          {"roughness_sa_nm", p.roughness_sa_nm},
          {"waviness_sa_nm", p.waviness_sa_nm},
          {"correlation_length_um", p.correlation_length_um},
          {"rre", p.rre},
          {"std_error", p.std_error}};
}

std::string percent(double share) {
  return fixed(100.0 * share, 3);
}

}  // namespace

std::string roughness_json(const RoughnessResult& result) {
  const RoughnessRequest& asked = result.request;
  Json json = {{"design", design::to_json(result.design)},
               {"seed", asked.seed},
               {"incidence_deg", asked.incidence_deg},
               {"azimuth_deg", asked.azimuth_deg},
               {"correlation_length_um", asked.correlation_length_um},
               {"waviness_length_um", asked.waviness_length_um},
               {"smooth", {{"rre", result.smooth_rre}, {"std_error", result.smooth_std_error}}}};
  json["points"] = Json::array();
  json["measured"] = Json::array();
  for (const RoughnessPoint& p : result.points)
    if (p.measured)
      json["measured"].push_back(measured_json(p, result.measured[*p.measured]));
    else
      json["points"].push_back(curve_json(p));
  json["elapsed_s"] = result.elapsed_s;
  json["rays"] = result.rays;
  return result_text("retrace.roughness/1", json, result.warnings, result.complete);
}

std::string roughness_csv(const RoughnessResult& result) {
  CsvWriter csv("name,facets,correlation_length_um,roughness_sa_nm,waviness_sa_nm,rre,std_error");
  for (const RoughnessPoint& p : result.points) {
    const FacetGroup* const group = p.measured ? &result.measured[*p.measured] : nullptr;
    csv.add(group != nullptr ? group->name : "");
    csv.add(group != nullptr ? fmt::format("{}", group->facets) : "");
    csv.row(p.correlation_length_um, p.roughness_sa_nm, p.waviness_sa_nm, p.rre, p.std_error);
  }
  return csv.text();
}

std::string roughness_table(const RoughnessResult& result) {
  std::string table = fmt::format("smooth facets: RRE {} %\n", percent(result.smooth_rre));
  table += fmt::format("{:<12} {:>6}  {:>10} {:>12} {:>11} {:>8}  {}\n", "", "facets", "corr_um", "roughness_Sa",
                       "waviness_Sa", "RRE_%", "+-_%");
  for (const RoughnessPoint& p : result.points) {
    const FacetGroup* const group = p.measured ? &result.measured[*p.measured] : nullptr;
    table += fmt::format("{:<12} {:>6}  {:>10} {:>12} {:>11} {:>8}  {}\n", group ? printable(group->name) : "curve",
                         group ? fmt::format("{}", group->facets) : "", shortest(p.correlation_length_um),
                         fixed(p.roughness_sa_nm, 2), fixed(p.waviness_sa_nm, 2), percent(p.rre), percent(p.std_error));
  }
  return table;
}

}  // namespace retrace::studies
