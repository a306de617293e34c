#include "studies/setup/io/setup_files.h"

#include <string>

namespace retrace::studies {
namespace {

using namespace fabrication;
using Json = nlohmann::ordered_json;

Json point_json(const geometry::Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

Json axis_json(const RotaryAxis& axis) {
  return {{"point_mm", point_json(axis.point_mm.value)},
          {"point_source", axis.point_mm.source},
          {"direction", point_json(axis.direction.value)},
          {"direction_source", axis.direction.source}};
}

Json blank_json(const FabricationResult& result, const BlankSetup& blank) {
  Json json = {{"kind", kWorkpieceWords[static_cast<std::size_t>(result.job.workpiece.kind)]},
               {"array_x_mm", blank.array_mm.x()},
               {"array_y_mm", blank.array_mm.y()},
               {"deepest_mm", blank.deepest_mm}};
  if (!blank.base.empty()) {
    json["substrate"] = blank.base;
    json["stock_mm"] = blank.stock_mm;
  }
  if (!blank.zones.empty()) json["zones"] = blank.zones;
  if (blank.fixture_height_mm) json["fixture_height_mm"] = *blank.fixture_height_mm;
  if (blank.free_radius_mm > 0.0) json["free_radius_mm"] = blank.free_radius_mm;
  return json;
}

Json tool_json(const FabricationResult& result, const ToolSetup& tool) {
  const Tool& t = result.job.tool;
  Json json = {{"width_mm", t.width_mm},
               {"wedge_deg", t.wedge_deg},
               {"clearance_deg", t.clearance_deg},
               {"edge_radius_um", t.edge_radius_um},
               {"plunge_rake_deg", tool.plunge_rake_deg}};
  if (tool.plough_rake_deg) json["plough_rake_deg"] = *tool.plough_rake_deg;
  if (!tool.plough_rake_deg) json["nose_angle_deg"] = t.nose_angle_deg;
  if (tool.free_length_mm) json["free_length_mm"] = *tool.free_length_mm;
  json["mount_offset_mm"] = point_json(result.machine.mount.offset_mm.value);
  json["mount_rotation_deg"] = point_json(result.machine.mount.rotation_deg.value);
  return json;
}

Json travel_json(const std::vector<AxisTravel>& travel) {
  Json axes = Json::array();
  for (const AxisTravel& axis : travel)
    axes.push_back({{"axis", std::string(1, axis.axis)},
                    {"low", axis.low},
                    {"high", axis.high},
                    {"limits", {axis.limits.low, axis.limits.high}}});
  return axes;
}

Json checks_json(const FabricationResult& result, const std::vector<StageCheck>& checks) {
  Json rows = Json::array();
  for (const StageCheck& check : checks) {
    rows.push_back({{"stage", check.stage},
                    {"program", result.program_file(check.program)},
                    {"ends_s", check.ends_s},
                    {"remaining_um", check.remaining_um}});
    if (check.root_depth_mm > 0.0) rows.back()["root_depth_mm"] = check.root_depth_mm;
  }
  return rows;
}

Json stops_json(const FabricationResult& result) {
  Json rows = Json::array();
  for (const PlannedStop& stop : result.plan.stops)
    rows.push_back({{"program", result.program_file(stop.program)},
                    {"reason", kStopReasonWords[static_cast<std::size_t>(stop.reason)]},
                    {"stage", result.plan.stages[stop.stage].name},
                    {"element", stop.element},
                    {"at_s", stop.at_s},
                    {"ran_s", stop.wear.seconds},
                    {"cut_mm", stop.wear.cut_mm}});
  return rows;
}

Json sensitivities_json(const FabricationResult& result, const SetupSheet& sheet) {
  Json rows = Json::array();
  for (const Sensitivity& row : sheet.sensitivities.rows) {
    Json facets = Json::array();
    for (std::size_t k = 0; k < row.facets.size(); ++k)
      facets.push_back({{"facet", sheet.sensitivities.kinds[k].facet + 1},
                        {"rotated", sheet.sensitivities.kinds[k].rotated},
                        {"distance_nm", row.facets[k].distance_nm},
                        {"up_arcmin", row.facets[k].up_arcmin},
                        {"along_arcmin", row.facets[k].along_arcmin},
                        {"farthest_nm", row.facets[k].farthest_nm}});
    Json json = {{"quantity", row.quantity->key}, {"description", row.quantity->description},
                 {"unit", row.quantity->unit()},  {"facets", std::move(facets)},
                 {"chip_nm", row.chip_nm},        {"root_residual_nm", row.root_residual_nm},
                 {"root_cut_nm", row.root_cut_nm}};
    if (result.machine.tilt == Tilt::table) json["wall_nm"] = row.wall_nm;
    if (const PartLight* const change = sheet.change_of_light(*row.quantity, result.machine.tilt)) {
      json["rre_change"] = change->rre;
      json["r_a_change"] = change->r_a;
    }
    rows.push_back(std::move(json));
  }
  return rows;
}

Json light_json(const SetupLight& light) {
  return {{"elements", light.elements},
          {"cones_deg", light.cones_deg},
          {"rre", light.nominal.rre},
          {"observation_deg", SetupLight::kObservationDeg},
          {"entrance_deg", SetupLight::kEntranceDeg},
          {"r_a", light.nominal.r_a}};
}

}  // namespace

Json setup_json(const FabricationResult& result, const SetupSheet& sheet) {
  Json json = {{"blank", blank_json(result, sheet.blank)}, {"tool", tool_json(result, sheet.tool)}};
  json[result.machine.tilt == Tilt::table ? "axis_a" : "axis_b"] = axis_json(result.machine.a);
  json["axis_c"] = axis_json(result.machine.c);
  json["control_needs"] = sheet.control_needs;
  json["first_z_mm"] = result.machine.first_z_mm();
  json["mist"] = result.job.process.mist;
  json["travel"] = travel_json(sheet.travel);
  json["optional_stops"] = sheet.optional_stops;
  json["warm_up_s"] = result.machine.warm_up_s.value;
  json["stops"] = stops_json(result);
  json["checks"] = checks_json(result, sheet.checks);
  json["sensitivities"] = sensitivities_json(result, sheet);
  if (sheet.light) json["light"] = light_json(*sheet.light);
  return json;
}

}  // namespace retrace::studies
