#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/schema/json_schema.h"
#include "design/io/design_format.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/turning/io/part_files.h"
#include "materials/io/material_library.h"
#include "studies/quantity/io/study_format.h"
#include "studies/ranging/io/cubes_reader.h"

namespace retrace::app {
namespace {

/// Returns the file formats that have a schema, sorted by name.
std::vector<const schema::Format*> formats() {
  return {&studies::cubes_format(),       &design::design_format(),       &fabrication::job_format(),
          &fabrication::machine_format(), &materials::materials_format(), &fabrication::planed_part_format(),
          &fabrication::process_format(), &studies::study_format(),       &fabrication::turning::turned_part_format()};
}

struct SchemaOptions {
  std::optional<std::string> format;
};

std::vector<Argument> arguments(SchemaOptions& options) {
  const auto names = [] {
    Words words;
    for (const schema::Format* const format : formats()) words.emplace_back(format->name);
    return words;
  };
  return {{"FORMAT", "name of a format [the list of formats]", &options.format, one_of(names)}};
}

ExitCode write_schema(const CommonOptions& common, const std::string& json, const std::string& text,
                      const std::string& file) {
  const ResultFiles files(common, {}, file);
  files.prepare();
  return files.write(json, text);
}

ExitCode list_formats(const CommonOptions& common) {
  std::string text = fmt::format("{:<12} {:<22} {}\n", "name", "schema", "title");
  nlohmann::ordered_json json = {{"formats", nlohmann::ordered_json::array()}};
  for (const schema::Format* const format : formats()) {
    text += fmt::format("{:<12} {:<22} {}\n", format->name, format->id, format->title);
    json["formats"].push_back({{"name", format->name}, {"schema", format->id}, {"title", format->title}});
  }
  return write_schema(common, result_text("retrace.formats/1", json, {}), text, "formats.json");
}

ExitCode run(const SchemaOptions& options, const CommonOptions& common) {
  if (!options.format) return list_formats(common);
  std::vector<std::string_view> names;
  for (const schema::Format* const format : formats()) {
    names.push_back(format->name);
    if (format->name != *options.format) continue;
    const std::string text = to_text(schema::json_schema(*format));
    return write_schema(common, text, text, *options.format + ".schema.json");
  }
  throw InputError(fmt::format("schema: must be {}, got {}", fmt::join(names, ", "), printable(*options.format)));
}

}  // namespace

Command schema_command() {
  return {.name = "schema",
          .summary = "JSON Schema of a file format, for editors and validators",
          .manual =
              "Prints the JSON Schema (draft-07) of a file format, for editors and validators; without FORMAT the "
              "list of formats that have one.",
          .writes = {"JSON Schema", "retrace.formats/1"},
          .begin = begins<SchemaOptions>(arguments, run)};
}

}  // namespace retrace::app
