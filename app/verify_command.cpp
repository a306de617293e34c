#include <chrono>
#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "core/atomic_file.h"
#include "fabrication/job/io/job_files.h"
#include "raytrace/threads.h"
#include "report/error_map_plot.h"
#include "studies/closed_loop/as_machined.h"
#include "studies/closed_loop/error_map.h"
#include "studies/closed_loop/io/verification_files.h"
#include "studies/closed_loop/verification.h"
#include "studies/design/facet_planes_reader.h"

namespace retrace::app {
namespace {

namespace fs = std::filesystem;

studies::VerificationRun verified(const CommandLine& line, double& elapsed_s) {
  studies::VerificationRequest request;
  request.job = line.verify.job;
  request.programs = line.verify.programs;
  request.dialect = line.verify.dialect;
  request.tolerance_nm = line.verify.tolerance_nm;
  studies::VerificationRun run;
  const auto start = std::chrono::steady_clock::now();
  raytrace::run_with_threads(line.common.threads.value_or(0), [&] { run = studies::run_verification(request); });
  elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

/// The table of planes that goes with an as-machined design: part.toml -> part_facets.csv.
fs::path facets_file_of(const fs::path& design) {
  return design.parent_path() / (design.stem().string() + "_facets.csv");
}

}  // namespace

ExitCode run_verify_command(const CommandLine& line) {
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "verify reads no design");
  std::vector<std::string> files_read = line.verify.programs;
  files_read.push_back(line.verify.job);
  if (const fs::path machine = fabrication::read_job(line.verify.job).machine; machine.has_extension())
    files_read.push_back(machine.string());
  const fs::path facets_file = facets_file_of(line.verify.as_machined);
  if (!line.verify.as_machined.empty())
    for (const fs::path& written : {fs::path(line.verify.as_machined), facets_file})
      check_output_file(line.common, "--as-machined", written, files_read);
  if (!line.verify.map.empty()) check_output_file(line.common, "--map", line.verify.map, files_read);
  double elapsed_s = 0.0;
  studies::VerificationRun run = verified(line, elapsed_s);
  std::string design;
  std::string facets;
  if (!line.verify.as_machined.empty()) {
    const studies::AsMachined part = studies::as_machined(run);
    run.warnings.insert(run.warnings.end(), part.warnings.begin(), part.warnings.end());
    design = studies::as_machined_toml(run, part, facets_file.filename().string());
    if (part.planes) facets = studies::facet_planes_text(*part.planes);
  }
  std::string map;
  if (!line.verify.map.empty()) map = report::render_png(report::error_map_plot(studies::error_map(run)));
  const std::string json = studies::verification_json(run, elapsed_s);
  prepare_outputs(line.common, {files_read, "verification.json", {}});
  if (!facets.empty()) write_file_atomically(facets_file, facets);
  if (!design.empty()) write_file_atomically(line.verify.as_machined, design);
  if (!map.empty()) write_file_atomically(line.verify.map, map);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = {{"verification.json", json}};
  write_outputs(line.common, json, files, studies::verification_table(run));
  print_warnings(line.common, run.warnings);
  return run.result.passes() ? ExitCode::done : ExitCode::answer_is_no;
}

}  // namespace retrace::app
