#include <chrono>
#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/read/nc_program.h"
#include "raytrace/sampling/threads.h"
#include "report/results/result_plots.h"
#include "studies/closed_loop/as_machined.h"
#include "studies/closed_loop/io/verification_files.h"
#include "studies/closed_loop/verification.h"
#include "studies/design/io/facet_planes_reader.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

struct VerifyOptions {
  studies::VerificationRequest request;
  std::string as_machined;  ///< design file to write; empty: none
  std::string map;          ///< PNG to write; empty: none
};

Words dialects() {
  Words words = words_of(fabrication::kNcDialectWords)();
  words.insert(words.begin(), "auto");
  return words;
}

std::vector<Argument> arguments(VerifyOptions& options) {
  return {
      job_argument(options.request.job),
      {"PROGRAM", "NC programs, in the order in which they run", &options.request.programs, files("")},
      {"--dialect DIALECT", "rs274ngc, sinumerik, fanuc or pmac, or auto: told from the text", &options.request.dialect,
       one_of(dialects)},
      {"--tolerance-nm T", "that facet planes may differ from the design by", &options.request.tolerance_nm},
      {"--map FILE", "draw what the programs leave over the facets to a PNG FILE", &options.map, files(".png")},
      {"--as-machined FILE", "write the part that is left as a design to FILE", &options.as_machined, files(".toml")}};
}

studies::VerificationRun verified(const studies::VerificationRequest& request, const CommonOptions& common,
                                  double& elapsed_s) {
  studies::VerificationRun run;
  const auto start = std::chrono::steady_clock::now();
  raytrace::run_with_threads(common.threads.value_or(0), [&] { run = studies::run_verification(request); });
  elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

std::vector<std::string> inputs_of(const studies::VerificationRequest& request) {
  std::vector<std::string> files = request.programs;
  files.push_back(request.job);
  if (const fs::path machine = fabrication::read_job(request.job).machine; machine.has_extension())
    files.push_back(machine.string());
  return files;
}

/// The table of planes that goes with an as-machined design: part.toml -> part_facets.csv.
fs::path facets_file_of(const fs::path& design) {
  return design.empty() ? fs::path() : design.parent_path() / (design.stem().string() + "_facets.csv");
}

ExitCode run(const VerifyOptions& options, const CommonOptions& common) {
  const fs::path facets_file = facets_file_of(options.as_machined);
  studies::VerificationRun run;
  std::string design;
  std::string facets;
  ResultFiles files(common, inputs_of(options.request), "verification.json");
  files.add_named("--as-machined", options.as_machined, [&] { return design; });
  files.add_named("--as-machined", facets_file, [&] { return facets; });
  files.add_named("--map", options.map,
                  [&] { return report::render_png(report::error_map_plot(studies::error_map(run))); });
  files.check();
  double elapsed_s = 0.0;
  run = verified(options.request, common, elapsed_s);
  if (!options.as_machined.empty()) {
    const studies::AsMachined part = studies::as_machined(run);
    run.warnings.insert(run.warnings.end(), part.warnings.begin(), part.warnings.end());
    design = studies::as_machined_toml(run, part, facets_file.filename().string());
    if (part.planes) facets = studies::facet_planes_text(*part.planes);
  }
  files.prepare();
  return files.write(studies::verification_json(run, elapsed_s), studies::verification_table(run), run.warnings,
                     {.is_yes = run.result.passes()});
}

}  // namespace

Command verify_command() {
  return {.name = "verify",
          .summary = "what NC programs really cut, against their fabrication job",
          .manual =
              "Reads NC programs as a controller would, cuts the blank through the axes of the job's machine and "
              "says, by line, what differs from the design. With `--as-machined` the part that is left is "
              "written as a design, with `--map` it is drawn. Exits with 1 if anything was found.",
          .reads = {"retrace.job/1", "retrace.machine/1", "NC programs"},
          .writes = {"retrace.verification/1", "retrace.design/1"},
          .refuses_set = "verify reads no design",
          .begin = begins<VerifyOptions>(arguments, run)};
}

}  // namespace retrace::app
