#include "retrace/verify.h"

#include <chrono>
#include <memory>

#include "core/atomic_file.h"
#include "core/threads.h"
#include "geometry/io/facet_planes_reader.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/closed_loop/as_machined.h"
#include "studies/closed_loop/io/verification_files.h"
#include "studies/closed_loop/verification.h"

namespace retrace {

struct Verification::Content {
  studies::VerificationRun run;
};

namespace {

/// Writes the as-machined design, such as part.toml. If its facets have individual planes, the table of these planes is
/// written to the same folder, such as part_facets.csv.
void write_as_machined(studies::VerificationRun& run, const std::filesystem::path& file) {
  const studies::AsMachined part = studies::as_machined(run);
  append(run.warnings, part.warnings);
  const std::filesystem::path facets = file.parent_path() / (file.stem().string() + "_facets.csv");
  const std::string design = studies::as_machined_toml(run, part, facets.filename().string());
  if (part.planes) write_file_atomically(facets, geometry::facet_planes_text(*part.planes));
  write_file_atomically(file, design);
}

}  // namespace

Verification verify(const VerificationRequest& request, const Running& running) {
  const auto start = std::chrono::steady_clock::now();
  const auto held = std::make_shared<Verification::Content>();
  studies::VerificationRun& run = held->run;
  run_with_threads(running.threads, [&] { run = studies::run_verification(request, running.cancellation); });
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!request.as_machined.empty()) write_as_machined(run, request.as_machined);
  Verification result;
  result.passes = run.result.passes();
  result.verdict = run.result.verdict();
  for (const fabrication::Finding& finding : run.result.findings)
    result.findings.push_back(
        {finding.kind, finding.program, finding.line, finding.message, finding.value, finding.limit});
  result.warnings = run.warnings;
  result.json = studies::verification_json(run, elapsed_s);
  result.table = studies::verification_table(run);
  result.map = drawing_of([held] { return report::error_map_plot(studies::error_map(held->run)); });
  result.content = held;
  return result;
}

void write_as_machined(const Verification& verification, const std::filesystem::path& design) {
  studies::VerificationRun run = verification.content->run;  // a copy, because warnings are added to it
  write_as_machined(run, design);
}

}  // namespace retrace
