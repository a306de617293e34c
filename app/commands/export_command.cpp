#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "studies/appearance/io/appearance_files.h"
#include "studies/design/io/design_reader.h"
#include "studies/solids/io/solid_files.h"
#include "studies/solids/solids.h"

namespace retrace::app {
namespace {

const studies::AppearanceRequest kUsual;

struct ExportOptions {
  std::string design;
  std::optional<std::string> file;  ///< output file, which can also be given by --out
  std::string what = "array";
  std::optional<double> block_mm;
  std::optional<double> entrance_deg, window_deg, error, source_arcmin, receiver_arcmin;
  std::optional<std::uint64_t> most_directions;
};

std::vector<Argument> arguments(ExportOptions& options) {
  const auto kinds = [] {
    using studies::SolidKind;
    Words words;
    for (const SolidKind kind : {SolidKind::element, SolidKind::array, SolidKind::mould})
      words.push_back(studies::name_of(kind));
    return words;
  };
  return {
      design_argument(options.design),
      {"FILE",
       "file to write: .stl, .obj, .glb, .step or .stp; a material: .json, .xml or .glsl; the same as --out FILE",
       &options.file, files("")},
      {"--what WHAT", "solid: element, array, or mould (the block behind the part's back)", &options.what,
       one_of(kinds)},
      {"--block-mm T", "mould: thickness of the block below its deepest point [the plate's thickness]",
       &options.block_mm},
      {"--entrance-deg B", fmt::format("material: largest entrance angle [{:g}]", kUsual.entrance_deg),
       &options.entrance_deg},
      {"--window-deg W", fmt::format("material: largest angle between view and source [{:g}]", kUsual.window_deg),
       &options.window_deg},
      {"--source-arcmin D", "material: diameter of the source [10]", &options.source_arcmin},
      {"--receiver-arcmin D", "material: diameter of the receiver [10]", &options.receiver_arcmin},
      {"--error E", fmt::format("material: relative error to reach [{:g}]", kUsual.error), &options.error},
      {"--most-directions N",
       fmt::format("material: maximum number of directions of light that are computed [{}]", kUsual.most_directions),
       &options.most_directions}};
}

/// Refuses options of solids if a material is written, and options of materials if a solid is written.
void check_options(const ExportOptions& options, bool is_material) {
  const auto refuse = [&](const char* option, bool is_given) {
    if (is_given)
      throw InputError({"", 0, option},
                       is_material ? "is of solids: a material has none" : "is of materials: .json, .xml or .glsl");
  };
  refuse("--what", is_material && options.what != "array");
  refuse("--block-mm", is_material && options.block_mm);
  refuse("--entrance-deg", !is_material && options.entrance_deg);
  refuse("--window-deg", !is_material && options.window_deg);
  refuse("--source-arcmin", !is_material && options.source_arcmin);
  refuse("--receiver-arcmin", !is_material && options.receiver_arcmin);
  refuse("--error", !is_material && options.error);
  refuse("--most-directions", !is_material && options.most_directions);
}

studies::AppearanceRequest appearance_request(const ExportOptions& options) {
  studies::AppearanceRequest request = kUsual;
  request.entrance_deg = options.entrance_deg.value_or(request.entrance_deg);
  request.window_deg = options.window_deg.value_or(request.window_deg);
  request.error = options.error.value_or(request.error);
  request.most_directions = options.most_directions.value_or(request.most_directions);
  if (options.source_arcmin) request.apertures.source = Angle::from_deg(*options.source_arcmin / 60.0);
  if (options.receiver_arcmin) request.apertures.receiver = Angle::from_deg(*options.receiver_arcmin / 60.0);
  return request;
}

/// Computes how a design reflects light and writes the result as a material for other programs. The format `table`
/// consists of two files: the values are in a CSV file in the same folder.
ExitCode run_material(const ExportOptions& options, const CommonOptions& common, const std::string& file,
                      studies::AppearanceFormat format) {
  const studies::Design design = studies::read_design(options.design, common.overrides);
  const studies::AppearanceRequest request = appearance_request(options);
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
      "material", {fmt::format("give a larger --error (now {:g})", request.error), "give fewer --most-directions"}};
  OrderlyInterrupt().run(common, running, [&](Progress* bar, const Cancellation* cancel) {
    result = studies::compute_appearance(design, request, bar, cancel);
  });
  if (!result.complete) {
    say("retrace: interrupted; nothing was written");
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
    throw InputError({"", 0, "--out"}, "FILE was given already, as " + *options.file);
  return options.file.value_or(common.out);
}

ExitCode run(const ExportOptions& options, const CommonOptions& common) {
  const std::string file = output_file(options, common);
  const auto material = studies::appearance_format(file);
  check_options(options, material.has_value());
  if (material) return run_material(options, common, file, *material);
  const auto format = file.empty() ? studies::SolidFormat::stl : studies::solid_format(file);
  studies::SolidRequest request;
  request.what = studies::read_solid_kind(options.what);
  request.block_mm = options.block_mm;
  const studies::Design design = studies::read_design(options.design, common.overrides);
  const studies::Solid solid = studies::make_solid(design, request);
  ResultFiles files(without_folder(common), files_read({design}));
  files.add_named("--out", file, [&] { return studies::solid_text(solid, format); });
  files.prepare();
  return files.write(studies::solid_json(solid, file), studies::solid_table(solid), solid.warnings);
}

}  // namespace

Command export_command() {
  return {
      .name = "export",
      .summary = "a design's solid as STL, OBJ, glTF or STEP; its reflection as a material",
      .manual =
          "Writes a solid of a design as STL, OBJ, glTF or STEP, by the ending of FILE, or how it sends light "
          "back as a material for renderers and simulators: a table of R_A (.json, with a .csv beside it), a "
          "BSDF of Radiance (.xml), or lobes in a shader (.glsl).",
      .reads = {"retrace.design/1"},
      .writes = {"retrace.export/1", "STL", "OBJ", "glTF", "STEP", "retrace.material/1", "BSDF of Radiance", "GLSL"},
      .begin = begins<ExportOptions>(arguments, run)};
}

}  // namespace retrace::app
