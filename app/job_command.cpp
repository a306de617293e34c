#include <filesystem>

#include "app/commands.h"
#include "app/job_output.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "studies/design/design_reader.h"
#include "studies/fabrication/io/fabrication_files.h"
#include "studies/fabrication/reachable.h"

namespace retrace::app {
namespace fs = std::filesystem;

namespace {

/// What a chisel makes of cube corners: a design and the table of its planes, part.toml and part_facets.csv.
ExitCode write_reachable(const CommandLine& line, const studies::Design& design) {
  if (!line.common.out.empty())
    throw InputError({"", 0, "--out"}, "makes a job: not allowed together with --reachable");
  const fs::path file = line.job.reachable;
  const fs::path facets_file = file.parent_path() / (file.stem().string() + "_facets.csv");
  const studies::JobRequest request = job_request(line.job, *line.job.tool_width_mm);
  const studies::ReachablePart part = studies::reachable_part(design, request, facets_file.filename().string());
  FileNames names{files_read({design}), "", {}};
  for (const std::string& read : files_of_making(line.job)) names.inputs.push_back(read);
  prepare_outputs(line.common, names);
  for (const fs::path& written : {file, facets_file})
    check_output_file(line.common, "--reachable", written, names.inputs);
  write_file_atomically(facets_file, part.facets);
  write_file_atomically(file, part.design);
  write_outputs(line.common, studies::reach_json(part, request), {},
                studies::reach_table(part) + "wrote " + file.string() + " and " + facets_file.string() + "\n");
  return ExitCode::done;
}

}  // namespace

ExitCode run_job_command(const CommandLine& line) {
  const studies::Design design = studies::read_design(line.job.design, line.common.overrides);
  if (!line.job.reachable.empty()) return write_reachable(line, design);
  studies::MadeJob made = studies::make_job(design, job_request(line.job, *line.job.tool_width_mm));
  // With job, --out names the job file, not a folder.
  CommonOptions outputs = line.common;
  const fs::path out = outputs.out;
  outputs.out.clear();
  const std::string text = job_text_at(made, out);
  FileNames names{files_read({design}), "", {}};
  for (const std::string& file : files_of_making(line.job)) names.inputs.push_back(file);
  prepare_outputs(outputs, names);
  if (!out.empty()) {
    check_output_file(outputs, "--out", out, names.inputs);
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
