#include <fmt/format.h>

#include <optional>

#include "app/commands.h"
#include "app/points_run.h"
#include "report/results/result_plots.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/tolerance/io/tolerance_files.h"
#include "studies/tolerance/io/tolerance_reader.h"

namespace retrace::app {
namespace {

ExitCode run_tolerance(const StudyOptions& options, const CommonOptions& common) {
  PointsCommand command;
  command.doing = "making parts";
  command.store = "tolerance.sqlite";
  command.document = "tolerance.json";
  studies::ToleranceRequest request;
  studies::ToleranceResult found;
  command.add_files = [&](ResultFiles& files, const auto& result) {
    files.add("parts.csv", [&] { return studies::sweep_csv(*result); });
    files.add_drawing("tolerance", [&] { return report::tolerance_plot(result->sweep.study(), request, found); });
  };
  std::optional<studies::Sweep> sweep;
  command.read = [&] {
    studies::Study study = studies::read_study(options.study, common.overrides, common.seed);
    request = studies::read_tolerance(study);
    command.fewer_points = fmt::format("give a smaller tolerance.samples (now {})", request.samples);
    sweep.emplace(studies::tolerance_sweep(std::move(study), request));
    return *sweep;
  };
  command.so_far = [&](const std::vector<compute::StoredPoint>& points) {
    return studies::so_far_text(studies::analyse(*sweep, request, points), request);
  };
  command.write = [&](studies::SweepResult& result, const ResultFiles& files) {
    found = studies::analyse(result.sweep, request, result.points);
    append(result.warnings, found.warnings);
    return files.write(
        studies::tolerance_json(result, request, found),
        without_middle(studies::tolerance_text(result.sweep.study(), request, found), common, "tolerance.json"), {},
        {.is_yes = found.is_enough});
  };
  return run_points(options, common, command);
}

}  // namespace

Command tolerance_command() {
  return {
      .name = "tolerance",
      .summary = "effect of manufacturing errors on a design, as defined in a study file",
      .manual =
          "Computes parts with random manufacturing errors, as the parameters of a study define them, and reports the "
          "distribution of the quantities, the yield, and the main contributors. Points are kept in `tolerance.sqlite` "
          "in the output folder. Exits with 1 if the yield is below the required yield or every point failed.",
      .reads = {"retrace.study/1", "retrace.design/1"},
      .writes = {"retrace.tolerance/2"},
      .begin = begins(study_arguments, run_tolerance)};
}

}  // namespace retrace::app
