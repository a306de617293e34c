#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/study_options.h"
#include "raytrace/threads.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/optimise/io/optimum_files.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::app {
namespace {

constexpr const char* kStore = "optimum.sqlite";

}  // namespace

ExitCode run_optimize_command(const CommandLine& line) {
  check_study_options(line);
  const auto start = std::chrono::steady_clock::now();
  const studies::Study study = studies::read_study(line.study.study, line.common.overrides, line.common.seed);
  const studies::OptimiseRequest request = studies::read_optimise(study);
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common, {files_of_study(study), "optimum.json", {"front.csv", kStore}});
  const std::filesystem::path file =
      line.common.out.empty() ? std::filesystem::path() : std::filesystem::path(line.common.out) / kStore;
  studies::ResultStore store(file, studies::optimise_layout(study), if_exists_of(line.study));
  studies::Optimum optimum;
  raytrace::run_with_threads(line.common.threads.value_or(0), [&] {
    optimum = studies::optimise(study, request, store, nullptr, &interrupt.cancellation());
  });
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string json = studies::optimum_json(study, request, optimum, elapsed_s);
  write_outputs(line.common, json, {{"optimum.json", json}, {"front.csv", studies::front_csv(study, optimum)}},
                studies::optimum_text(study, request, optimum));
  if (!optimum.complete) {
    say(fmt::format("retrace: interrupted; designs looked at: {}", optimum.evaluations));
    return ExitCode::interrupted;
  }
  if (optimum.best) return ExitCode::done;
  say("retrace: no feasible design: " + optimum.none_because);
  return ExitCode::answer_is_no;
}

}  // namespace retrace::app
