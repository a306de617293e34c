#include "app/commands.h"
#include "app/points_run.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/io/sweep_reader.h"

namespace retrace::app {

ExitCode run_sweep_command(const CommandLine& line) {
  PointsCommand command;
  command.doing = "sweeping";
  command.store = "sweep.sqlite";
  command.document = "sweep.json";
  command.others = {"sweep.csv"};
  command.read = [&] {
    return studies::read_sweep(studies::read_study(line.study.study, line.common.overrides, line.common.seed));
  };
  command.write = [&](studies::SweepResult& result) {
    const std::string json = studies::sweep_json(result);
    write_outputs(line.common, json, {{"sweep.json", json}, {"sweep.csv", studies::sweep_csv(result)}},
                  studies::sweep_table(result));
    return ExitCode::done;
  };
  return run_points(line, command);
}

}  // namespace retrace::app
