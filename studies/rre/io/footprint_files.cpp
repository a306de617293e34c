#include "studies/rre/io/footprint_files.h"

#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/version.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

/// Closed: the first corner comes again at the end.
Json ring_of(const geometry::Polygon& outline) {
  Json ring = Json::array();
  for (std::size_t k = 0; k <= outline.size(); ++k) {
    const geometry::Vec2& p = outline[k % outline.size()];
    ring.push_back(Json::array({p.x(), p.y()}));
  }
  return ring;
}

Json direction_and_cone_of(const RrePoint& at) {
  return {{"design", at.design},
          {"incidence_deg", at.incidence_deg},
          {"azimuth_deg", at.azimuth_deg},
          {"wavelength_nm", at.wavelength_nm},
          {"acceptance_half_angle_deg", at.acceptance_half_angle_deg}};
}

Json feature_of(const RrePoint& at, const ActiveRegion& region) {
  Json feature = {{"type", "Feature"}};
  feature["geometry"] = {{"type", "Polygon"}, {"coordinates", Json::array({ring_of(region.outline_mm)})}};
  feature["properties"] = direction_and_cone_of(at);
  feature["properties"]["efficiency"] = region.efficiency;
  return feature;
}

Json summary_of(const RrePoint& at, const Footprint& footprint) {
  Json summary = direction_and_cone_of(at);
  summary["entrance_area_mm2"] = footprint.entrance_area_mm2;
  summary["active_area_mm2"] = footprint.active_area_mm2;
  summary["active_share"] = footprint.active_share();
  summary["rre_shown"] = footprint.rre_shown();
  summary["rre"] = at.rre;
  return summary;
}

}  // namespace

std::string footprint_json(const RreResult& result) {
  Json json = {{"schema", "retrace.footprint/1"}, {"type", "FeatureCollection"}};
  json["features"] = Json::array();
  json["regions"] = Json::array();
  for (const ReturnedLight& light : result.returned) {
    if (!light.footprint) continue;
    for (const ActiveRegion& region : light.footprint->regions)
      json["features"].push_back(feature_of(light.at, region));
    json["regions"].push_back(summary_of(light.at, *light.footprint));
  }
  json["version"] = kVersion;
  json["warnings"] = result.warnings;
  json["complete"] = result.complete;
  return to_text(json);
}

}  // namespace retrace::studies
