#include "app/commands.h"
#include "app/points_run.h"
#include "report/tolerance_plot.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/tolerance/io/tolerance_files.h"
#include "studies/tolerance/io/tolerance_reader.h"

namespace retrace::app {

ExitCode run_tolerance_command(const CommandLine& line) {
  PointsCommand command;
  command.doing = "making parts";
  command.store = "tolerance.sqlite";
  command.document = "tolerance.json";
  command.others = {"parts.csv", "tolerance.svg", "tolerance.png"};
  studies::ToleranceRequest request;
  command.read = [&] {
    studies::Study study = studies::read_study(line.study.study, line.common.overrides, line.common.seed);
    request = studies::read_tolerance(study);
    return studies::tolerance_sweep(std::move(study), request);
  };
  command.write = [&](studies::SweepResult& result) {
    const studies::ToleranceResult found = studies::analyse(result.sweep, request, result.points);
    result.warnings.insert(result.warnings.end(), found.warnings.begin(), found.warnings.end());
    const std::string json = studies::tolerance_json(result, request, found);
    const report::LinePlot plot = report::tolerance_plot(result.sweep.study(), request, found);
    std::vector<OutputFile> files;
    if (!line.common.out.empty())
      files = {{"tolerance.json", json},
               {"parts.csv", studies::sweep_csv(result)},
               {"tolerance.svg", report::render_svg(plot)},
               {"tolerance.png", report::render_png(plot)}};
    write_outputs(line.common, json, files, studies::tolerance_text(result.sweep.study(), request, found));
    return found.is_enough ? ExitCode::done : ExitCode::answer_is_no;
  };
  return run_points(line, command);
}

}  // namespace retrace::app
