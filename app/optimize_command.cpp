#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/job_output.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/study_options.h"
#include "core/atomic_file.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/io/optimum_files.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::app {
namespace {

constexpr const char* kStore = "optimum.sqlite";

/// The job of the chosen design; the tool is that of the command line, or that of the study at that design.
studies::MadeJob job_of(const CommandLine& line, const studies::Study& study, const studies::Variant& best) {
  const studies::Candidate candidate = studies::make_candidate(study, best.values);
  const std::optional<double> width_mm =
      line.job.tool_width_mm ? line.job.tool_width_mm : candidate.machining().tool_width_mm;
  if (!width_mm)
    throw InputError({"", 0, "--tool-width-mm"},
                     "is required with --job where the study has no machining.tool_width_mm");
  return studies::make_job(candidate.design(), job_request(line.job, *width_mm));
}

std::vector<std::string> inputs_of(const CommandLine& line, const studies::Study& study) {
  std::vector<std::string> files = study.files;
  if (!line.study.job.empty())
    for (const std::string& file : files_of_making(line.job)) files.push_back(file);
  return files;
}

/// What would otherwise be found wrong only after the search.
void check_job_options(const CommandLine& line, const studies::Study& study) {
  if (line.study.job.empty()) return;
  const studies::JobRequest request = job_request(line.job, line.job.tool_width_mm.value_or(1.0));
  studies::check_making(request);
  studies::check_element(studies::make_candidate(study, some_values(study)).design(), request);
  check_output_file(line.common, "--job", line.study.job, inputs_of(line, study));
}

class LooksBar : public studies::OptimiseObserver {
 public:
  explicit LooksBar(bool enabled) : bar_("looking", enabled) {}
  void at(std::size_t evaluated) override { bar_.count(fmt::format("{} designs looked at", evaluated)); }

 private:
  ProgressBar bar_;
};

}  // namespace

ExitCode run_optimize_command(const CommandLine& line) {
  check_study_options(line);
  const auto start = std::chrono::steady_clock::now();
  const studies::Study study = studies::read_study(line.study.study, line.common.overrides, line.common.seed);
  const studies::OptimiseRequest request = studies::read_optimise(study);
  check_job_options(line, study);
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common, {inputs_of(line, study), "optimum.json", {"front.csv", kStore}});
  const std::filesystem::path file =
      line.common.out.empty() ? std::filesystem::path() : std::filesystem::path(line.common.out) / kStore;
  studies::ResultStore store(file, studies::optimise_layout(study), if_exists_of(line.study));
  studies::Optimum optimum;
  {
    LooksBar bar(!line.common.quiet);
    interrupt.run(line.common.threads, [&](const Cancellation* cancel) {
      optimum = studies::optimise(study, request, store, &bar, cancel);
    });
  }
  std::optional<studies::MadeJob> made;
  if (optimum.best && !line.study.job.empty()) made = job_of(line, study, *optimum.best);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string json = studies::optimum_json(study, request, optimum, elapsed_s);
  write_outputs(line.common, json, {{"optimum.json", json}, {"front.csv", studies::front_csv(study, optimum)}},
                studies::optimum_text(study, request, optimum));
  if (made) {
    write_file_atomically(line.study.job, job_text_at(*made, line.study.job));
    print_warnings(line.common, made->warnings);
  }
  if (!optimum.complete) {
    say(fmt::format("retrace: interrupted; designs looked at: {}", optimum.evaluations));
    return ExitCode::interrupted;
  }
  if (optimum.best) return ExitCode::done;
  say("retrace: no feasible design: " + optimum.none_because);
  return ExitCode::answer_is_no;
}

}  // namespace retrace::app
