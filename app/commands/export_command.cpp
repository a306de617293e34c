
#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "studies/design/io/design_reader.h"
#include "studies/solids/io/solid_files.h"
#include "studies/solids/solids.h"

namespace retrace::app {
namespace {

struct ExportOptions {
  std::string design;
  std::optional<std::string> file;  ///< the same as --out
  std::string what = "array";
  std::optional<double> block_mm;
};

std::vector<Argument> arguments(ExportOptions& options) {
  const auto kinds = [] {
    using studies::SolidKind;
    Words words;
    for (const SolidKind kind : {SolidKind::element, SolidKind::array, SolidKind::mould})
      words.push_back(studies::name_of(kind));
    return words;
  };
  return {design_argument(options.design),
          {"FILE", "file to write: .stl, .obj, .glb, .step or .stp; the same as --out FILE", &options.file, files("")},
          {"--what WHAT", "element, array or mould: the block behind the part's back", &options.what, one_of(kinds)},
          {"--block-mm T", "of a mould, below its deepest point [the plate's thickness]", &options.block_mm}};
}

/// The file to write: DESIGN FILE and -o FILE are the same.
std::string output_file(const ExportOptions& options, const CommonOptions& common) {
  if (options.file && !common.out.empty())
    throw InputError({"", 0, "--out"}, "FILE was given already, as " + *options.file);
  return options.file.value_or(common.out);
}

ExitCode run(const ExportOptions& options, const CommonOptions& common) {
  const std::string file = output_file(options, common);
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
  return {.name = "export",
          .summary = "a design's solid as STL, OBJ, glTF or STEP",
          .manual = "Writes a solid of a design as STL, OBJ, glTF or STEP, by the ending of FILE.",
          .reads = {"retrace.design/1"},
          .writes = {"retrace.export/1", "STL", "OBJ", "glTF", "STEP"},
          .begin = begins<ExportOptions>(arguments, run)};
}

}  // namespace retrace::app
