#include "studies/rre/io/far_field_files.h"

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/json_text.h"
#include "core/number_format.h"
#include "core/version.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;
using Fields = std::array<std::pair<std::string_view, double>, 6>;

Json direction_of(const RrePoint& at) {
  return {{"design", at.design},
          {"incidence_deg", at.incidence_deg},
          {"azimuth_deg", at.azimuth_deg},
          {"wavelength_nm", at.wavelength_nm}};
}

Fields fields_of(const FarFieldSpot& spot) {
  const raytrace::Stokes& s = spot.stokes;
  return {{{"deviation_arcmin", 60.0 * spot.deviation.deg()},
           {"deviation_azimuth_deg", spot.orientation.deg()},
           {"power", s.i},
           {"s1", s.q / s.i},
           {"s2", s.u / s.i},
           {"s3", s.v / s.i}}};
}

Json spot_of(const FarFieldSpot& spot) {
  Json json = Json::object();
  for (const auto& [name, value] : fields_of(spot)) json[std::string(name)] = value;
  json["depth_min"] = spot.least_depth;
  return json;
}

std::string line_of(const RrePoint& at, const FarFieldSpot& spot) {
  std::string line = std::to_string(at.design);
  for (const double value : {at.incidence_deg, at.azimuth_deg, at.wavelength_nm}) line += ',' + shortest(value);
  for (const auto& [name, value] : fields_of(spot)) line += ',' + shortest(value);
  return line + ',' + std::to_string(spot.least_depth) + '\n';
}

}  // namespace

std::string far_field_json(const RreResult& result) {
  Json json = {{"schema", "retrace.far_field/1"}};
  json["directions"] = Json::array();
  for (const ReturnedLight& light : result.returned) {
    if (!light.far_field) continue;
    Json direction = direction_of(light.at);
    direction["total_power"] = light.far_field->total_power;
    direction["other_power"] = light.far_field->other_power;
    direction["spots"] = Json::array();
    for (const FarFieldSpot& spot : light.far_field->spots) direction["spots"].push_back(spot_of(spot));
    json["directions"].push_back(std::move(direction));
  }
  json["version"] = kVersion;
  json["warnings"] = result.warnings;
  json["complete"] = result.complete;
  return to_text(json);
}

std::string far_field_csv(const RreResult& result) {
  std::string csv = "design,incidence_deg,azimuth_deg,wavelength_nm";
  for (const auto& [name, value] : fields_of({})) csv += ',' + std::string(name);
  csv += ",depth_min\n";
  for (const ReturnedLight& light : result.returned)
    if (light.far_field)
      for (const FarFieldSpot& spot : light.far_field->spots) csv += line_of(light.at, spot);
  return csv;
}

}  // namespace retrace::studies
