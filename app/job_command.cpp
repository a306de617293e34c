#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "fabrication/job/io/job_files.h"
#include "studies/design/design_reader.h"
#include "studies/fabrication/io/fabrication_files.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

/// A machine's file is named as seen from where the job lies.
void name_machine_from(fabrication::Job& job, const fs::path& folder) {
  const fs::path machine = job.machine;
  if (!machine.has_extension() || machine.is_absolute()) return;
  std::error_code error;
  const fs::path relative = fs::relative(machine, folder.empty() ? fs::path(".") : folder, error);
  if (!error && !relative.empty()) job.machine = relative.string();
}

}  // namespace

ExitCode run_job_command(const CommandLine& line) {
  const studies::Design design = studies::read_design(line.job.design, line.common.overrides);
  studies::JobRequest request;
  request.machine = line.job.machine;
  request.tool_width_mm = line.job.tool_width_mm;
  request.strategy = line.job.strategy;
  request.process = line.job.process;
  request.workpiece = line.job.workpiece;
  request.shrinkage_percent = line.job.shrinkage_percent;
  studies::MadeJob made = studies::make_job(design, request);
  // With job, --out names the job file, not a folder.
  CommonOptions outputs = line.common;
  const fs::path out = outputs.out;
  outputs.out.clear();
  name_machine_from(made.job, out.parent_path());
  const std::string text = fabrication::job_text(made.job);
  FileNames names{files_read({design}), "", {}};
  if (design.mask) names.designs.push_back(design.mask->file.string());
  // Names without an ending are shipped ones, not files.
  for (const std::string& name : {request.machine, request.process})
    if (fs::path(name).has_extension()) names.designs.push_back(name);
  prepare_outputs(outputs, names);
  if (!out.empty()) {
    for (const std::string& read : names.designs) {
      std::error_code ignored;
      if (read != "-" && fs::equivalent(read, out, ignored))
        throw InputError({"", 0, "--out"}, out.string() + " is a file that is read; it would be overwritten");
    }
    if (!outputs.json.empty() && fs::absolute(outputs.json).lexically_normal() == fs::absolute(out).lexically_normal())
      throw InputError({"", 0, "--json"}, outputs.json + " is the file that --out writes; give another name");
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
