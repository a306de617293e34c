#include "app/commands.h"
#include "app/output.h"
#include "studies/design/design_reader.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"

namespace retrace::app {

ExitCode run_inspect_command(const CommandLine& line) {
  const studies::Design design = studies::read_design(line.design, line.common.overrides);
  const studies::Inspection inspection = studies::inspect(design, materials::MaterialLibrary::shipped());
  prepare_outputs(line.common, {files_read({design}), "inspect.json", {}});
  const std::string json = studies::inspect_json(inspection);
  write_outputs(line.common, json, {{"inspect.json", json}}, studies::inspect_text(inspection));
  print_warnings(line.common, inspection.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
