#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/schema/json_schema.h"
#include "core/version.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "materials/io/material_library.h"
#include "studies/design/design_format.h"

namespace retrace::app {
namespace {

/// The formats of files that have a schema, by name.
std::vector<const schema::Format*> formats() {
  return {&studies::design_format(), &fabrication::machine_format(), &materials::materials_format(),
          &fabrication::process_format()};
}

ExitCode write_schema(const CommandLine& line, const nlohmann::ordered_json& json, const std::string& text,
                      const std::string& file) {
  prepare_outputs(line.common, {{}, file, {}});
  write_outputs(line.common, to_text(json), {{file, to_text(json)}}, text);
  return ExitCode::done;
}

ExitCode list_formats(const CommandLine& line) {
  std::string text = fmt::format("{:<10} {:<20} {}\n", "name", "schema", "title");
  nlohmann::ordered_json json = {{"schema", "retrace.formats/1"}, {"formats", nlohmann::ordered_json::array()}};
  for (const schema::Format* const format : formats()) {
    text += fmt::format("{:<10} {:<20} {}\n", format->name, format->id, format->title);
    json["formats"].push_back({{"name", format->name}, {"schema", format->id}, {"title", format->title}});
  }
  json["version"] = kVersion;
  json["warnings"] = nlohmann::ordered_json::array();
  json["complete"] = true;
  return write_schema(line, json, text, "formats.json");
}

}  // namespace

ExitCode run_schema_command(const CommandLine& line) {
  if (line.what.empty()) return list_formats(line);
  std::vector<std::string_view> names;
  for (const schema::Format* const format : formats()) {
    names.push_back(format->name);
    if (format->name != line.what) continue;
    const nlohmann::ordered_json json = schema::json_schema(*format);
    return write_schema(line, json, to_text(json), line.what + ".schema.json");
  }
  throw InputError(fmt::format("schema: must be {}, got {}", fmt::join(names, ", "), printable(line.what)));
}

}  // namespace retrace::app
