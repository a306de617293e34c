#include "report/page/former_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/schema/reader.h"
#include "core/text.h"
#include "design/io/design_format.h"

namespace retrace::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSchema = "retrace.";

/// Renamed keys and values of documents. Each entry contains the kind of document, the former name and the current
/// name.
constexpr std::string_view kOfDocuments[][3] = {
    {"inspect", "base", "substrate"},
    {"inspect", "base.least_radius_mm", "substrate.min_radius_mm"},
    {"inspect", "front", "entrance_surface"},
    {"inspect", "entrance.clean_share", "entrance.clean_fraction"},
    {"inspect", "entrance.haze_share", "entrance.haze_fraction"},
    {"inspect", "dead_zone_share", "dead_zone_fraction"},
    {"inspect", "packing_share", "packing_fraction"},
    {"inspect", "share_within_acceptance", "fraction_within_acceptance"},
    {"inspect", "full_element_share", "full_element_area_fraction"},
    {"inspect", "meets_two_zones[].share", "meets_two_zones[].fraction"},
    {"inspect", "zones[].wander_mm", "zones[].lateral_shift_mm"},
    {"footprint", "regions[].active_share", "regions[].active_fraction"},
    {"photometry", "programme", "test_plan"},
    {"calibration", "freedom", "degrees_of_freedom"},
    {"calibration", "quantities[].words", "quantities[].description"},
    {"calibration", "quantities[].told", "quantities[].observable"},
    {"calibration", "untold", "unobservable"},
    {"calibration", "quantities[].quantity=tool_turn_x_arcsec", "quantities[].quantity=tool_rotation_x_arcsec"},
    {"calibration", "quantities[].quantity=tool_turn_y_arcsec", "quantities[].quantity=tool_rotation_y_arcsec"},
    {"calibration", "quantities[].quantity=tool_turn_z_arcsec", "quantities[].quantity=tool_rotation_z_arcsec"},
    {"correction", "freedom", "degrees_of_freedom"},
    {"correction", "quantities[].words", "quantities[].description"},
    {"correction", "quantities[].told", "quantities[].observable"},
    {"correction", "untold", "unobservable"},
    {"correction", "quantities[].quantity=tool_turn_x_arcsec", "quantities[].quantity=tool_rotation_x_arcsec"},
    {"correction", "quantities[].quantity=tool_turn_y_arcsec", "quantities[].quantity=tool_rotation_y_arcsec"},
    {"correction", "quantities[].quantity=tool_turn_z_arcsec", "quantities[].quantity=tool_rotation_z_arcsec"},
    {"correction", "maps[].middle_mm", "maps[].centre_mm"},
    {"correction", "marks[].place_um", "marks[].position_um"},
    {"time_calibration", "freedom", "degrees_of_freedom"},
    {"time_calibration", "quantities[].words", "quantities[].description"},
    {"time_calibration", "quantities[].told", "quantities[].observable"},
    {"time_calibration", "untold", "unobservable"},
    {"test_cuts", "figures", "measurement_count"},
    {"test_cuts", "quantities[].words", "quantities[].description"},
    {"test_cuts", "quantities[].told", "quantities[].observable"},
    {"test_cuts", "untold", "unobservable"},
    {"test_cuts", "quantities[].quantity=tool_turn_x_arcsec", "quantities[].quantity=tool_rotation_x_arcsec"},
    {"test_cuts", "quantities[].quantity=tool_turn_y_arcsec", "quantities[].quantity=tool_rotation_y_arcsec"},
    {"test_cuts", "quantities[].quantity=tool_turn_z_arcsec", "quantities[].quantity=tool_rotation_z_arcsec"},
    {"fabrication", "poses[].turned", "poses[].rotated"},
    {"fabrication", "poses[].tilt", "poses[].orientation"},
    {"fabrication", "setup.blank.base", "setup.blank.substrate"},
    {"fabrication", "setup.tool.mount_turn_deg", "setup.tool.mount_rotation_deg"},
    {"fabrication", "setup.checks[].left_um", "setup.checks[].remaining_um"},
    {"fabrication", "setup.sensitivities[].words", "setup.sensitivities[].description"},
    {"fabrication", "setup.sensitivities[].facets[].turned", "setup.sensitivities[].facets[].rotated"},
    {"fabrication", "setup.sensitivities[].root_left_nm", "setup.sensitivities[].root_residual_nm"},
    {"fabrication", "setup.sensitivities[].quantity=tool_turn_x_arcsec",
     "setup.sensitivities[].quantity=tool_rotation_x_arcsec"},
    {"fabrication", "setup.sensitivities[].quantity=tool_turn_y_arcsec",
     "setup.sensitivities[].quantity=tool_rotation_y_arcsec"},
    {"fabrication", "setup.sensitivities[].quantity=tool_turn_z_arcsec",
     "setup.sensitivities[].quantity=tool_rotation_z_arcsec"},
    {"verification", "chip_share_max", "chip_ratio_max"},
    {"verification", "standing_mm_max", "excess_mm_max"},
    {"verification", "frames", "blocks"},
    {"verification", "programs[].frames", "programs[].blocks"},
    {"verification", "programs[].seconds_per_frame", "programs[].seconds_per_block"},
    {"verification", "scallop_most_nm", "scallop_nm_max"},
    {"verification", "findings[].kind=turn_too_low", "findings[].kind=rotation_too_low"},
    {"planing", "standing_mm_max", "excess_mm_max"},
    {"planing", "frames", "blocks"},
    {"planing", "programs[].frames", "programs[].blocks"},
    {"planing", "seconds_per_frame", "seconds_per_block"},
    {"planing", "programs[].seconds_per_frame", "programs[].seconds_per_block"},
    {"planing", "published_seconds_per_frame", "published_seconds_per_block"},
    {"turning", "tool.skew_is_least", "tool.skew_is_min"},
    {"turning", "verification.scallop_most_nm", "verification.scallop_nm_max"},
    {"turning", "cubics.scallop_most_nm", "cubics.scallop_nm_max"},
    {"composition", "zones[].share", "zones[].area_fraction"},
    {"composition", "least", "goal_min"},
    {"composition", "by_number_of_zones[].most_zones", "by_number_of_zones[].max_zones"},
    {"composition", "by_number_of_zones[].least", "by_number_of_zones[].goal_min"},
    {"composition", "by_number_of_zones[].zones[].share", "by_number_of_zones[].zones[].area_fraction"},
    {"composition", "front[].least", "front[].goal_min"},
    {"composition", "front[].zones[].share", "front[].zones[].area_fraction"},
    {"composition", "best_of_one_cell.least", "best_of_one_cell.goal_min"},
    {"composition", "errors_of_angle.least", "errors_of_angle.goal_min"},
    {"composition", "errors_of_angle.yield.least_of_95_percent", "errors_of_angle.yield.goal_min_of_95_percent"},
    {"composition", "errors_of_angle.worst_share", "errors_of_angle.worst_fraction"},
    {"composition", "errors_of_angle.best_for_worst.zones[].share",
     "errors_of_angle.best_for_worst.zones[].area_fraction"},
    {"composition", "errors_of_angle.best_for_worst.yield.least_of_95_percent",
     "errors_of_angle.best_for_worst.yield.goal_min_of_95_percent"},
    {"composition", "errors_of_angle.missed_by", "errors_of_angle.approximation_error_max"},
    {"tolerance", "least_yield", "min_yield"},
    {"tolerance", "quantities[].least", "quantities[].min"},
    {"tolerance", "quantities[].most", "quantities[].max"},
    {"material", "most_entrance_deg", "max_entrance_deg"},
    {"material", "error_asked", "error_requested"},
    {"material", "error.greatest", "error.max"},
    {"export", "most_entrance_deg", "max_entrance_deg"},
    {"export", "error_asked", "error_requested"},
    {"export", "error.greatest", "error.max"},
    {"export", "error_of_lobes.greatest", "error_of_lobes.max"},
    {"reach", "reached_share", "reached_fraction"},
    {"reach", "reached_share_cut", "reached_fraction_cut"},
};

std::vector<FormerName> all_former_names() {
  std::vector<FormerName> names;
  const std::vector<TomlRename> of_designs = schema::former_names(design::design_format());
  const std::vector<TomlRename> back = reversed(of_designs);
  for (const TomlRename& rename : of_designs)
    names.push_back(
        {"", path_in(current_path(rename.table, back), rename.former), path_in(rename.table, rename.current)});
  for (const auto& [kind, former, current] : kOfDocuments)
    names.push_back({std::string(kind), std::string(former), std::string(current)});
  return names;
}

/// Divides a text at a separator. The second part is empty if the text does not contain the separator.
std::pair<std::string_view, std::string_view> split_at(std::string_view text, std::size_t at) {
  if (at == std::string_view::npos) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

/// Calls `apply` for each object at a path below `json`. Does nothing where the path does not exist.
void for_objects_at(Json& json, std::string_view path, const std::function<void(Json&)>& apply) {
  if (json.is_array()) {
    for (Json& entry : json) for_objects_at(entry, path, apply);
    return;
  }
  if (!json.is_object()) return;
  if (path.empty()) {
    apply(json);
    return;
  }
  auto [name, rest] = split_at(path, path.find('.'));
  if (name.ends_with("[]")) name.remove_suffix(2);
  if (const auto found = json.find(std::string(name)); found != json.end()) for_objects_at(*found, rest, apply);
}

/// Renames a key of an object and keeps the order of the keys. Does nothing if the object has the new name already.
void rename_key(Json& object, const std::string& former, const std::string& current) {
  if (!object.contains(former) || object.contains(current)) return;
  Json renamed = Json::object();
  for (auto& member : object.items())
    renamed[member.key() == former ? current : member.key()] = std::move(member.value());
  object = std::move(renamed);
}

void rename_value(Json& object, const std::string& key, std::string_view former, std::string_view current) {
  const auto found = object.find(key);
  if (found != object.end() && found->is_string() && found->get<std::string>() == former) *found = std::string(current);
}

/// Replaces the former names of one kind. Objects are renamed before the keys that they contain.
void replace_names(Json& json, std::string_view kind) {
  for (const FormerName& name : former_names()) {
    if (name.kind != kind) continue;
    const auto [former_path, former_value] = split_at(name.former, name.former.find('='));
    const auto [path, value] = split_at(name.current, name.current.find('='));
    const std::size_t dot = path.rfind('.');
    const std::string_view parent = dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
    const std::string key(path.substr(dot + 1));
    const std::string former_key(former_path.substr(former_path.rfind('.') + 1));
    for_objects_at(json, parent, [&, is = value, was = former_value](Json& object) {
      if (is.empty())
        rename_key(object, former_key, key);
      else
        rename_value(object, key, was, is);
    });
  }
}

/// Returns the version as a number, or 0 if it is not a positive whole number.
int number_of(const std::string& version) {
  int number = 0;
  const auto [end, error] = std::from_chars(version.data(), version.data() + version.size(), number);
  return error == std::errc() && end == version.data() + version.size() ? std::max(number, 0) : 0;
}

}  // namespace

const std::vector<FormerName>& former_names() {
  static const std::vector<FormerName> names = all_former_names();
  return names;
}

int current_version(std::string_view kind) {
  return !kind.empty() && std::ranges::any_of(former_names(), [&](const FormerName& name) { return name.kind == kind; })
             ? 2
             : 1;
}

DocumentSchema schema_of(const Json& document) {
  if (!document.is_object() || !document.contains("schema") || !document["schema"].is_string()) return {};
  const auto schema = document["schema"].get<std::string>();
  if (!schema.starts_with(kSchema)) return {};
  const auto [kind, version] = split_at(schema, schema.find('/'));
  return {std::string(kind.substr(kSchema.size())), std::string(version)};
}

void replace_former_names(Json& document, const std::string& file) {
  const DocumentSchema schema = schema_of(document);
  if (schema.kind.empty()) return;
  const int version = number_of(schema.version);
  const int current = current_version(schema.kind);
  if (version < 1 || version > current)
    throw InputError({file, 0, "schema"},
                     fmt::format("must be \"retrace.{}/{}\"{}, got {}; update retrace, or run the command that writes "
                                 "this file again",
                                 printable(schema.kind), current, current > 1 ? " or a former version" : "",
                                 in_quotes(document["schema"].get<std::string>())));
  if (version < current) replace_names(document, schema.kind);
  for_objects_at(document, "design", [](Json& design) { replace_names(design, ""); });
  for_objects_at(document, "designs[]", [](Json& design) { replace_names(design, ""); });
}

std::string current_document(const std::string& text) {
  Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) return text;
  const Json given = document;
  replace_former_names(document);
  const DocumentSchema schema = schema_of(document);
  if (!schema.kind.empty())
    document["schema"] = fmt::format("{}{}/{}", kSchema, schema.kind, current_version(schema.kind));
  return document == given ? text : to_text(document);
}

}  // namespace retrace::report
