#include <chrono>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "studies/closed_loop/io/verification_files.h"
#include "studies/closed_loop/verification.h"

namespace retrace::app {

ExitCode run_verify_command(const CommandLine& line) {
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "verify reads no design");
  studies::VerificationRequest request;
  request.job = line.verify.job;
  request.programs = line.verify.programs;
  request.dialect = line.verify.dialect;
  request.tolerance_nm = line.verify.tolerance_nm;
  std::vector<std::string> files_read = request.programs;
  files_read.push_back(request.job);
  const auto start = std::chrono::steady_clock::now();
  const studies::VerificationRun run = studies::run_verification(request);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const std::string json = studies::verification_json(run, elapsed.count());
  prepare_outputs(line.common, {files_read, "verification.json", {}});
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = {{"verification.json", json}};
  write_outputs(line.common, json, files, studies::verification_table(run));
  print_warnings(line.common, run.warnings);
  return run.result.passes() ? ExitCode::done : ExitCode::answer_is_no;
}

}  // namespace retrace::app
