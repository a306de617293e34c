#include <filesystem>

#include "app/commands.h"
#include "app/job_output.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/calibration/io/calibration_files.h"
#include "studies/fabrication/io/fabrication_files.h"
#include "studies/fabrication/reachable.h"

namespace retrace::app {
namespace fs = std::filesystem;
namespace {

struct JobOptions : MakingOptions {
  std::string design;
  /// Output file for a design that has the facets that a chisel can cut, in place of ideal cube corners. If empty, no
  /// such design is written.
  std::string reachable;
  /// Output folder for jobs of test cuts, from which the machine is calibrated; no test cuts if empty.
  std::string test_cuts;
};

std::vector<Argument> arguments(JobOptions& options) {
  std::vector<Argument> all = making_arguments(options, "");
  all.insert(all.begin(), design_argument(options.design));
  all.push_back(
      {"--reachable FILE",
       "instead of a job, write a design of the part that a chisel with a straight edge can make of cube corners",
       &options.reachable, files(".toml")});
  all.push_back({"--test-cuts FOLDER",
                 "instead of a job, write jobs of a few prisms that show how the machine is set up, and the table for "
                 "their measurements",
                 &options.test_cuts, not_with("--reachable")});
  return all;
}

/// Returns all files that the command reads.
std::vector<std::string> inputs_of(const JobRequest& request, const design::Design& design) {
  std::vector<std::string> inputs = files_read({design});
  for (const std::string& file : files_of_making(request)) inputs.push_back(file);
  return inputs;
}

/// Writes a design that has the facets that a chisel can cut, in place of ideal cube corners. The output is a design
/// file, such as part.toml, and the table of its facet planes, such as part_facets.csv.
ExitCode write_reachable(const JobOptions& options, const CommonOptions& common, const design::Design& design) {
  if (!common.out.empty())
    throw InputError({"", 0, "--out"}, "not allowed together with --reachable, which writes no job");
  const fs::path file = options.reachable;
  const fs::path facets_file = file.parent_path() / (file.stem().string() + "_facets.csv");
  const JobRequest request = job_request(options, common);
  const studies::ReachablePart part = studies::reachable_part(design, request, facets_file.filename().string());
  ResultFiles files(common, inputs_of(request, design));
  files.add_named("--reachable", file, [&] { return part.design; });
  files.add_named("--reachable", facets_file, [&] { return part.facets; });
  files.prepare();
  return files.write(studies::reach_json(part, request), studies::reach_table(part));
}

/// Writes jobs of test cuts, and measurements.csv, in which the user enters the measured values.
ExitCode write_test_cuts(const JobOptions& options, const CommonOptions& common, const design::Design& design) {
  if (!common.out.empty())
    throw InputError({"", 0, "--out"}, "not allowed together with --test-cuts, which writes no job for the design");
  const fs::path folder = options.test_cuts;
  const JobRequest request = job_request(options, common);
  studies::TestCuts cuts = studies::plan_test_cuts(design, request);
  CommonOptions outputs = common;
  outputs.out = options.test_cuts;
  ResultFiles files(outputs, inputs_of(request, design), "test_cuts.json");
  for (std::size_t k = 0; k < cuts.jobs.size(); ++k)
    files.add(cuts.parts.jobs[k], [&, k] { return job_text_at(cuts.jobs[k], folder / cuts.parts.jobs[k]); });
  files.add("measurements.csv", [&] { return studies::test_cuts_csv(cuts); });
  files.prepare();
  return files.write(studies::test_cuts_json(cuts), studies::test_cuts_table(cuts));
}

ExitCode run(const JobOptions& options, const CommonOptions& common) {
  const design::Design design = design::read_design(options.design, common.overrides);
  if (!options.test_cuts.empty()) return write_test_cuts(options, common, design);
  if (!options.reachable.empty()) return write_reachable(options, common, design);
  const JobRequest request = job_request(options, common);
  studies::GeneratedJob made = studies::make_job(design, request);
  const std::string text = job_text_at(made, common.out);
  TextFiles files(common, inputs_of(request, design));
  return files.write(studies::job_json(made), text, made.warnings, {}, studies::job_table(made));
}

}  // namespace

Command job_command() {
  return {.name = "job",
          .summary = "a fabrication job from a design",
          .manual =
              "Makes a fabrication job of a design: blank, tool, machine, strategy and process. Elements on a "
              "substrate are cut at their positions on the substrate; pins are not cut. `--reachable FILE` writes, "
              "instead of a job, the part that a chisel can make of cube corners. `--test-cuts FOLDER` writes the "
              "smallest jobs from which `retrace calibrate` estimates the set-up of the machine.",
          .reads = {"retrace.design/1", "retrace.machine/1", "retrace.process/1"},
          .writes = {"retrace.job_summary/1", "retrace.job/1", "retrace.reach/2", "retrace.test_cuts/2"},
          .begin = begins<JobOptions>(arguments, run)};
}

}  // namespace retrace::app
