#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/points_run.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/io/sweep_reader.h"

namespace retrace::app {
namespace {

ExitCode run_sweep(const StudyOptions& options, const CommonOptions& common) {
  PointsCommand command;
  command.doing = "sweeping";
  command.store = "sweep.sqlite";
  command.document = "sweep.json";
  command.add_files = [](ResultFiles& files, const auto& result) {
    files.add("sweep.csv", [&] { return studies::sweep_csv(*result); });
  };
  std::optional<studies::Sweep> sweep;
  command.read = [&] {
    const studies::Study study = studies::read_study(options.study, common.overrides, common.seed);
    const auto samples = study.document->number_if("sweep.samples");
    command.fewer_points = samples ? fmt::format("give a smaller sweep.samples (now {:.0f})", *samples)
                                   : "give the parameters fewer values";
    sweep.emplace(studies::read_sweep(study));
    return *sweep;
  };
  command.so_far = [&](const std::vector<compute::StoredPoint>& points) {
    return studies::sweep_so_far(*sweep, points);
  };
  command.write = [&](const studies::SweepResult& result, const ResultFiles& files) {
    return files.write(studies::sweep_json(result), without_middle(studies::sweep_table(result), common, "sweep.csv"));
  };
  return run_points(options, common, command);
}

}  // namespace

Command sweep_command() {
  return {.name = "sweep",
          .summary = "designs and directions over ranges, as defined in a study file",
          .manual =
              "Computes every point of a study file: keys of a design over lists, ranges and samples. Finished points "
              "are kept in `sweep.sqlite` in the output folder, so that a later run can continue. Exits with 1 if "
              "every point failed.",
          .reads = {"retrace.study/1", "retrace.design/1"},
          .writes = {"retrace.sweep/1"},
          .begin = begins(study_arguments, run_sweep)};
}

}  // namespace retrace::app
