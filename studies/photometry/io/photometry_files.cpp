#include "studies/photometry/io/photometry_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/version.h"
#include "studies/design/design_json.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json point_json(const PhotometricPoint& p) {
  return {{"observation_deg", p.asked.observation_deg},
          {"v_deg", p.asked.v_deg},
          {"h_deg", p.asked.h_deg},
          {"rotation_deg", p.rotation_deg},
          {"value_mcd_per_lx", p.r_i_mcd_per_lx},
          {"std_error_mcd_per_lx", p.std_error_mcd_per_lx},
          {"limit_mcd_per_lx", p.limit_mcd_per_lx},
          {"margin", p.margin()},
          {"limit_as_given", p.asked.minimum},
          {"unit", unit_name(p.asked.unit)},
          {"limit_status", status_name(p.asked.status)},
          {"limit_line", p.asked.line},
          {"pass", p.passes()},
          {"r_a_cd_per_lx_m2", p.r_a},
          {"r_l_cd_per_lx_m2", p.r_l}};
}

Json points_json(const std::vector<PhotometricPoint>& points) {
  Json json = Json::array();
  for (const PhotometricPoint& p : points) json.push_back(point_json(p));
  return json;
}

Json direction_json(const PhotometricDirection& d) {
  Json json = {{"v_deg", d.v_deg},
               {"h_deg", d.h_deg},
               {"rotation_deg", d.rotation_deg},
               {"incidence_deg", d.incidence_deg},
               {"azimuth_deg", d.azimuth_deg},
               {"rre", d.rre},
               {"std_error", d.std_error},
               {"truncated", d.truncated}};
  if (d.split)
    json["far_field"] = {{"wavelength_nm", d.split->wavelength_nm},
                         {"window_power", d.split->window},
                         {"outside_power", d.split->outside},
                         {"geometric_power", d.split->geometric}};
  return json;
}

Json change_json(const PhotometricChange& change) {
  return {{"key", change.key},
          {"from", change.from},
          {"to", change.to},
          {"verdict", verdict_name(change.verdict)},
          {"points", points_json(change.points)}};
}

Json programme_json(const PhotometryResult& result) {
  const PhotometryRequest& asked = result.request;
  return {{"standard", asked.programme.standard},
          {"class", asked.programme.part_class},
          {"colour", asked.programme.colour},
          {"limits", asked.limits_source},
          {"limits_complete", asked.programme.is_complete}};
}

/// Rows of a table for the terminal.
std::string rows_of(const std::vector<PhotometricPoint>& points) {
  std::string table = fmt::format("{:>7} {:>6} {:>6} {:>9} {:>11} {:>11} {:>9} {:>8}  {}\n", "alpha", "V", "H",
                                  "rotation", "mcd/lx", "limit", "margin_%", "R_A", "verdict");
  for (const PhotometricPoint& p : points) {
    std::string verdict = p.passes() ? "pass" : "FAIL";
    if (p.asked.status == LimitStatus::recalled) verdict += " (limit unconfirmed)";
    table += fmt::format("{:>7} {:>6} {:>6} {:>9} {:>11} {:>11} {:>9} {:>8}  {}\n", fixed(p.asked.observation_deg, 2),
                         shortest(p.asked.v_deg), shortest(p.asked.h_deg), shortest(p.rotation_deg),
                         fixed(p.r_i_mcd_per_lx, 2), fixed(p.limit_mcd_per_lx, 2), fixed(100.0 * p.margin(), 1),
                         fixed(p.r_a, 1), verdict);
  }
  return table;
}

std::string verdict_text(Verdict verdict, const TestProgramme& programme) {
  switch (verdict) {
    case Verdict::pass:
      return "verdict: pass\n";
    case Verdict::unconfirmed:
      return programme.is_complete
                 ? "verdict: unconfirmed - every point holds, but not every limit is confirmed\n"
                 : "verdict: unconfirmed - every point holds, but the table is not all that the standard asks\n";
    case Verdict::fail:
      return "verdict: FAIL\n";
  }
  return {};
}

std::string change_text(const PhotometricChange& change, const TestProgramme& programme) {
  std::string text = fmt::format(
      "\n{} {} = {} (now {}):\n",
      change.verdict == Verdict::fail ? "the best of what was tried, but not enough:" : "what to change:", change.key,
      shortest(change.to), shortest(change.from));
  return text + rows_of(change.points) + verdict_text(change.verdict, programme);
}

}  // namespace

std::string photometry_json(const PhotometryResult& result) {
  const PhotometryRequest& asked = result.request;
  Json json = {{"schema", "retrace.photometry/1"},
               {"engine", result.engine},
               {"engine_requested", engine_name(asked.engine)},
               {"diffraction", result.has_diffraction},
               {"design", to_json(result.design)},
               {"programme", programme_json(result)},
               {"area_cm2", asked.area_cm2},
               {"light", asked.own_light ? "design" : "a"},
               {"dye", asked.dye},
               {"wavelengths_nm", result.wavelengths_nm},
               {"rotation_deg", asked.rotation_deg},
               {"source_arcmin", 60.0 * asked.apertures.source.deg()},
               {"receiver_arcmin", 60.0 * asked.apertures.receiver.deg()},
               {"window_deg", asked.window_deg},
               {"seed", asked.seed}};
  json["points"] = points_json(result.points);
  if (result.complete || !result.points.empty()) json["verdict"] = verdict_name(result.verdict);
  json["directions"] = Json::array();
  for (const PhotometricDirection& d : result.directions) json["directions"].push_back(direction_json(d));
  json["changes"] = Json::array();
  for (const PhotometricChange& change : result.changes) json["changes"].push_back(change_json(change));
  json["elapsed_s"] = result.elapsed_s;
  json["version"] = kVersion;
  json["warnings"] = result.warnings;
  json["complete"] = result.complete;
  return to_text(json);
}

std::string photometry_csv(const PhotometryResult& result) {
  std::string csv =
      "observation_deg,v_deg,h_deg,rotation_deg,value_mcd_per_lx,std_error_mcd_per_lx,limit_mcd_per_lx,margin,"
      "limit_status,pass,r_a_cd_per_lx_m2,r_l_cd_per_lx_m2\n";
  for (const PhotometricPoint& p : result.points) {
    for (const double value : {p.asked.observation_deg, p.asked.v_deg, p.asked.h_deg, p.rotation_deg, p.r_i_mcd_per_lx,
                               p.std_error_mcd_per_lx, p.limit_mcd_per_lx, p.margin()})
      csv += shortest(value) + ',';
    csv += fmt::format("{},{},{},{}\n", status_name(p.asked.status), p.passes(), shortest(p.r_a), shortest(p.r_l));
  }
  return csv;
}

std::string far_field_map_csv(const PhotometryResult& result) {
  std::string csv = "v_deg,h_deg,right_deg,up_deg,r_a_cd_per_lx_m2\n";
  for (const FarFieldMap& map : result.maps)
    for (std::size_t k = 0; k < map.r_a.size(); ++k) {
      const auto middle = [&](std::size_t bin) {
        return map.half_width_deg * (2.0 * (static_cast<double>(bin) + 0.5) / static_cast<double>(map.columns) - 1.0);
      };
      csv += fmt::format("{},{},{},{},{}\n", shortest(map.v_deg), shortest(map.h_deg),
                         fixed(middle(k % map.columns), 6), fixed(middle(k / map.columns), 6), shortest(map.r_a[k]));
    }
  return csv;
}

std::string photometry_table(const PhotometryResult& result) {
  const TestProgramme& programme = result.request.programme;
  std::string table = printable(programme.standard);
  if (!programme.part_class.empty()) table += ", class " + printable(programme.part_class);
  table += fmt::format(", {}, {} cm2, {}{}\n", printable(programme.colour), shortest(result.request.area_cm2),
                       result.request.own_light ? "the design's light" : "CIE A",
                       result.request.dye.empty() ? "" : ", dye " + printable(result.request.dye));
  table += rows_of(result.points);
  if (!result.points.empty()) table += verdict_text(result.verdict, programme);
  for (const PhotometricChange& change : result.changes) table += change_text(change, programme);
  return table;
}

}  // namespace retrace::studies
