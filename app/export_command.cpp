#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "studies/design/design_reader.h"
#include "studies/solids/io/solid_files.h"
#include "studies/solids/solids.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

/// The file to write: DESIGN FILE and -o FILE are the same.
std::string output_file(const CommandLine& line) {
  if (!line.solid.file.empty() && !line.common.out.empty())
    throw InputError({"", 0, "--out"}, "FILE was given already, as " + line.solid.file);
  return line.solid.file.empty() ? line.common.out : line.solid.file;
}

}  // namespace

ExitCode run_export_command(const CommandLine& line) {
  const std::string file = output_file(line);
  const auto format = file.empty() ? studies::SolidFormat::stl : studies::solid_format(file);
  studies::SolidRequest request;
  request.what = studies::read_solid_kind(line.solid.what);
  request.block_mm = line.solid.block_mm;
  const studies::Design design = studies::read_design(line.solid.design, line.common.overrides);
  const studies::Solid solid = studies::make_solid(design, request);
  // With export, --out names the file, not a folder.
  CommonOptions outputs = line.common;
  outputs.out.clear();
  const std::vector<std::string> read = files_read({design});
  prepare_outputs(outputs, {read, "", {}});
  if (!file.empty()) {
    check_output_file(outputs, "--out", file, read);
    write_file_atomically(file, studies::solid_text(solid, format));
  }
  write_outputs(outputs, studies::solid_json(solid, file), {},
                studies::solid_table(solid) + (file.empty() ? "" : "wrote " + file + "\n"));
  print_warnings(line.common, solid.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
