#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "design/io/design_reader.h"
#include "requests/descriptions.h"
#include "studies/appearance/io/appearance_files.h"
#include "studies/solids/io/solid_files.h"
#include "studies/solids/solids.h"

namespace retrace::app {
namespace {

struct ExportOptions {
  std::string design;
  std::optional<std::string> file;  ///< output file, which can also be given by --out
  FieldTexts fields;
};

std::vector<Argument> arguments(ExportOptions& options) {
  std::vector<Argument> all = {
      design_argument(options.design),
      {"FILE",
       "file to write: .stl, .obj, .glb, .step or .stp; a material: .json, .xml or .glsl; the same as --out FILE",
       &options.file, files("")}};
  const std::array<CommandRequest, 2> of_command = {
      {{.request = requests::description<SolidRequest>(), .label = "solid"},
       {.request = requests::description<MaterialRequest>(), .label = "material"}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

/// Refuses options of solids if a material is written, and options of materials if a solid is written. Options whose
/// value is the default are allowed.
void check_options(const ExportOptions& options, bool is_material) {
  const requests::Request& unused =
      is_material ? requests::description<SolidRequest>() : requests::description<MaterialRequest>();
  for (const requests::Row& row : unused.rows) {
    const std::optional<std::string>& given = options.fields.values.at(requests::option_of(row));
    if (given && *given != requests::text_of(row, unused.initial()))
      throw InputError(row.field(),
                       is_material
                           ? "only allowed if --out is a solid (.stl, .obj, .glb, .step or .stp), but it is a material"
                           : "only allowed if --out is a material (.json, .xml or .glsl)");
  }
}

/// Computes how a design reflects light and writes the result as a material for other programs. The format `table`
/// consists of two files: the values are in a CSV file in the same folder.
ExitCode run_material(const ExportOptions& options, const CommonOptions& common, const std::string& file,
                      studies::AppearanceFormat format) {
  const design::Design design = design::read_design(options.design, common.overrides);
  const auto request = request_of<MaterialRequest>(options.fields, common);
  const std::filesystem::path values = std::filesystem::path(file).replace_extension(".csv");
  studies::AppearanceResult result;
  studies::AppearanceText text;
  ResultFiles files(without_folder(common), files_read({design}));
  files.add_named("--out", file, [&] { return text.text; });
  if (format == studies::AppearanceFormat::table) files.add_named("--out", values, [&] { return text.values; });
  files.prepare();
  // The temporary OrderlyInterrupt exists only during the computation. A later interrupt ends the program immediately,
  // because only the writing of the files remains.
  const RunText running{
      "material", {fmt::format("give a larger --error (now {:g})", request.error), "give fewer --max-directions"}};
  OrderlyInterrupt().run(common, running, [&](Progress* bar, const Cancellation* cancel) {
    result = studies::compute_appearance(design, request, bar, cancel);
  });
  if (!result.complete) {
    print_to_stderr("retrace: interrupted; nothing was written");
    return ExitCode::interrupted;
  }
  text = studies::appearance_text(result, format, values.filename().string());
  return files.write(studies::appearance_json(result, text, file), studies::appearance_table(result, text),
                     result.warnings);
}

/// Returns the output file, which is given either by the argument FILE or by --out.
/// \throw InputError if both are given
std::string output_file(const ExportOptions& options, const CommonOptions& common) {
  if (options.file && !common.out.empty())
    throw InputError({"", 0, "--out"}, "not allowed together with the argument FILE, " + *options.file);
  return options.file.value_or(common.out);
}

ExitCode run(const ExportOptions& options, const CommonOptions& common) {
  const std::string file = output_file(options, common);
  const auto material = studies::appearance_format(file);
  check_options(options, material.has_value());
  if (material) return run_material(options, common, file, *material);
  const auto format = file.empty() ? studies::SolidFormat::stl : studies::solid_format(file);
  const auto request = request_of<SolidRequest>(options.fields, common);
  const design::Design design = design::read_design(options.design, common.overrides);
  const studies::Solid solid = studies::make_solid(design, request, studies::solid_entrance(format));
  ResultFiles files(without_folder(common), files_read({design}));
  files.add_named("--out", file, [&] { return studies::solid_text(solid, format); });
  files.prepare();
  if (format == studies::SolidFormat::step && !common.quiet)
    if (const std::string notice = studies::step_notice(solid); !notice.empty()) print_to_stderr("retrace: " + notice);
  return files.write(studies::solid_json(solid, file), studies::solid_table(solid), solid.warnings);
}

}  // namespace

Command export_command() {
  return {
      .name = "export",
      .summary = "a design's solid as STL, OBJ, glTF or STEP; its reflection as a material",
      .manual =
          "Writes the solid of a design as STL, OBJ, glTF or STEP, or its reflection as a material for renderers and "
          "simulators: a table of R_A (.json, with a .csv next to it), a BSDF of Radiance (.xml), or lobes in a shader "
          "(.glsl). The ending of FILE selects the format.",
      .reads = {"retrace.design/1"},
      .writes = {"retrace.export/2", "STL", "OBJ", "glTF", "STEP", "retrace.material/2", "BSDF of Radiance", "GLSL"},
      .begin = begins<ExportOptions>(arguments, run)};
}

}  // namespace retrace::app
