#include <filesystem>

#include "app/commands.h"
#include "app/job_output.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "studies/design/design_reader.h"
#include "studies/fabrication/io/fabrication_files.h"

namespace retrace::app {
namespace fs = std::filesystem;

ExitCode run_job_command(const CommandLine& line) {
  const studies::Design design = studies::read_design(line.job.design, line.common.overrides);
  studies::MadeJob made = studies::make_job(design, job_request(line.job, *line.job.tool_width_mm));
  // With job, --out names the job file, not a folder.
  CommonOptions outputs = line.common;
  const fs::path out = outputs.out;
  outputs.out.clear();
  const std::string text = job_text_at(made, out);
  FileNames names{files_read({design}), "", {}};
  for (const std::string& file : files_of_making(line.job)) names.designs.push_back(file);
  prepare_outputs(outputs, names);
  if (!out.empty()) {
    check_job_file(outputs, out, names.designs, "--out");
    write_file_atomically(out, text);
  }
  // Without --out the job is the result itself, which --quiet does not take away.
  outputs.quiet = line.common.quiet && !out.empty();
  write_outputs(outputs, studies::job_json(made), {},
                out.empty() ? text : studies::job_table(made) + "wrote " + out.string() + "\n");
  print_warnings(line.common, made.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
