#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/job_output.h"
#include "app/output.h"
#include "app/ranks.h"
#include "app/shared_arguments.h"
#include "app/study_bar.h"
#include "core/atomic_file.h"
#include "core/message_text.h"
#include "report/results/result_plots.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/io/optimum_files.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/machine_plan.h"
#include "studies/quantity/machining_limits.h"
#include "studies/sweep/shared_sweep.h"

namespace retrace::app {
namespace {

struct OptimizeOptions : StudyOptions {
  std::string job;  ///< output file for the fabrication job of the chosen design; not written if empty
  MakingOptions making;
};

std::vector<Argument> arguments(OptimizeOptions& options) {
  std::vector<Argument> all = study_arguments(options);
  all.push_back({"--job FILE", "write the fabrication job of the chosen design", &options.job, files(".toml")});
  for (Argument& argument : making_arguments(options.making, "--job")) all.push_back(std::move(argument));
  return all;
}

/// Returns the request for the fabrication job of a study. The table [machining] of the study gives the machine, the
/// process and the strategy if the command line does not.
JobRequest request_of_job(const OptimizeOptions& options, const CommonOptions& common, const studies::Study& study) {
  JobRequest request = job_request(options.making, common);
  if (options.job.empty()) return request;
  const auto is_given = [&](const char* option) {
    const auto found = options.making.fields.values.find(option);
    return found != options.making.fields.values.end() && found->second.has_value();
  };
  const studies::MachiningProcess machining = studies::make_candidate(study, example_values(study)).machining();
  if (!is_given("--machine") && !machining.machine.empty()) request.machine = machining.machine;
  if (!is_given("--process") && !machining.process.empty()) request.process = machining.process;
  if (!is_given("--strategy") && !machining.machine.empty())
    request.strategy = fabrication::kStrategyWords[static_cast<std::size_t>(machining.strategy)];
  return request;
}

/// Returns the fabrication job of the best design. The tool width is the value of --tool-width-mm or, without this
/// option, of the study's key machining.tool_width_mm. If [machining] names a machine, the job uses the tool and the
/// process of [machining].
studies::GeneratedJob job_of(JobRequest request, const studies::Study& study, const studies::Variant& best) {
  const studies::Candidate candidate = studies::make_candidate(study, best.values);
  if (request.tool_width_mm == 0.0) {
    const std::optional<double> width_mm = candidate.machining().tool_width_mm;
    if (!width_mm)
      throw InputError(Field{"tool_width_mm"},
                       "is required for --job, because the study does not contain machining.tool_width_mm");
    request.tool_width_mm = *width_mm;
  }
  studies::GeneratedJob made = studies::make_job(candidate.design(), request);
  if (!candidate.machining().machine.empty()) studies::take_machining(candidate.machining(), made.job);
  return made;
}

std::vector<std::string> inputs_of(const OptimizeOptions& options, const JobRequest& making,
                                   const studies::Study& study) {
  std::vector<std::string> files = study.files;
  if (!options.job.empty())
    for (const std::string& file : files_of_making(making)) files.push_back(file);
  return files;
}

studies::Study study_of(const OptimizeOptions& options, const CommonOptions& common) {
  return studies::with_machining_limits(studies::read_study(options.study, common.overrides, common.seed));
}

/// Checks the options of the fabrication job. The check is made before the search, because a search can take a long
/// time.
/// \throw InputError
void check_making_of(const OptimizeOptions& options, JobRequest request, const studies::Study& study) {
  if (options.job.empty()) return;
  // Without --tool-width-mm, the study determines the tool width of each design. These checks only need a positive
  // width.
  if (request.tool_width_mm == 0.0) request.tool_width_mm = 1.0;
  studies::check_job_request(request);
  studies::check_element(studies::make_candidate(study, example_values(study)).design(), request);
}

/// Returns the warnings that concern the study, the search or the fabrication job.
Warnings warnings_of(const studies::Study& study, const studies::Optimum& optimum,
                     const std::optional<studies::GeneratedJob>& made, compute::MpiSession* session) {
  Warnings warnings = remarks_of(session);
  append(warnings, studies::keys_without_effect(study));
  if (optimum.budget_failures > 0)
    warnings.push_back(
        {"designs_out_of_budget",
         fmt::format("{} of {} designs are not evaluated because a budget ran out; the first message is: {}",
                     optimum.budget_failures, optimum.designs.size(), optimum.budget_failure_reason)});
  if (made) append(warnings, made->warnings);
  return warnings;
}

/// Searches for the best design and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode search_and_write(const OptimizeOptions& options, const CommonOptions& common, compute::MpiSession* session) {
  const auto start = std::chrono::steady_clock::now();
  const studies::Study study = study_of(options, common);
  const studies::OptimiseRequest request = studies::read_optimise(study);
  studies::optimise_scan(study, request);  // throws an error for too many designs before a store is created
  const JobRequest making = request_of_job(options, common, study);
  check_making_of(options, making, study);
  const OrderlyInterrupt interrupt;
  studies::Optimum optimum;
  std::optional<studies::GeneratedJob> made;
  ResultFiles files(common, inputs_of(options, making, study), "optimum.json");
  files.add("front.csv", [&] { return studies::front_csv(study, optimum); });
  files.add("designs.csv", [&] { return studies::designs_csv(study, optimum); });
  const std::string best_comment =
      fmt::format("# Best design of {}\n", printable(std::filesystem::path(study.source).filename().string()));
  const auto best_text = [&](const studies::Variant& best) {
    return studies::variant_design_text(study, best, best_comment);
  };
  files.add("best.toml", [&] { return optimum.best ? best_text(*optimum.best) : std::string(); });
  files.add_named("--job", options.job, [&] { return made ? job_text_at(*made, options.job) : ""; });
  files.add_drawing("optimum", [&] { return report::optimum_plot(study, request, optimum); });
  files.add_drawing(
      "constraints", [&] { return report::constraints_plot(study, request, optimum); },
      [&] { return !request.constraints.empty(); });
  const std::filesystem::path file = files.reserve("optimum.sqlite");
  files.prepare();
  compute::ResultStore store(file, studies::optimise_layout(study), if_exists_of(options));
  {
    SearchBar bar(
        {"searching", to_shorten_study(study, fmt::format("give a smaller optimize.scan (now {})", request.scan))},
        "designs", common);
    bar.on_best([&](const studies::Variant& best) { return studies::short_text(study, request, best); },
                [&](const studies::Variant& best) {
                  // The file is written for each new best design, so that it exists even if the run is killed.
                  if (!file.empty()) write_file_atomically(file.parent_path() / "best.toml", best_text(best));
                });
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      if (const DistributeTasks share = distribute_among(session, slots(common), cancel))
        studies::distribute_sweep(studies::optimise_scan(study, request), store, &bar, share);
      optimum = studies::optimise(study, request, store, &bar, cancel);
    });
  }
  if (optimum.best && !options.job.empty()) made = job_of(making, study, *optimum.best);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Warnings warnings = warnings_of(study, optimum, made, session);
  const ExitCode code =
      files.write(studies::optimum_json(study, request, optimum, elapsed_s),
                  without_middle(studies::optimum_text(study, request, optimum), common, "optimum.json"), warnings,
                  {.complete = optimum.complete,
                   .interrupted = fmt::format("designs evaluated: {}", optimum.designs.size()),
                   .is_yes = optimum.best.has_value()});
  if (code != ExitCode::answer_is_no) return code;
  print_to_stderr("retrace: no feasible design: " + optimum.infeasible_reason);
  return optimum.budget_failures > 0 ? ExitCode::failed : code;
}

ExitCode run(const OptimizeOptions& options, const CommonOptions& common) {
  return run_on_ranks(
      common, slots(common), [&](compute::MpiSession* session) { return search_and_write(options, common, session); },
      [&] {
        const studies::Study study = study_of(options, common);
        return studies::compute_task(studies::optimise_scan(study, studies::read_optimise(study)));
      });
}

}  // namespace

Command optimize_command() {
  return {
      .name = "optimize",
      .summary = "the best design within constraints, as defined in a study file",
      .manual =
          "Searches for the best design within constraints, and reports why other designs were rejected. Evaluated "
          "designs are kept in `optimum.sqlite` in the output folder. Exits with 1 if no design is feasible, and with "
          "3 if no design is feasible and some were not evaluated because the memory or beam budget ran out. With "
          "`--job` the fabrication job of the chosen design is written, with the options of `job`.",
      .reads = {"retrace.study/1", "retrace.design/1"},
      .writes = {"retrace.optimum/1", "retrace.design/1", "retrace.job/1"},
      .begin = begins<OptimizeOptions>(arguments, run)};
}

}  // namespace retrace::app
