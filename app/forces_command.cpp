#include "app/commands.h"
#include "app/output.h"
#include "report/forces_plot.h"
#include "studies/forces/forces_study.h"
#include "studies/forces/io/forces_files.h"

namespace retrace::app {

ExitCode run_forces_command(const CommandLine& line) {
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "forces reads no design");
  studies::ForcesRequest request;
  request.job = line.forces.job;
  request.configuration = line.forces.configuration;
  request.facet = static_cast<int>(line.forces.facet);
  if (line.forces.plunge_mm) {
    if (!(*line.forces.plunge_mm > 0.0)) throw InputError({"", 0, "--plunge-mm"}, "must be > 0");
    request.plunge_mm = *line.forces.plunge_mm;
  }
  const studies::ForcesResult result = studies::cutting_forces(request);
  prepare_outputs(line.common, {{request.job}, "forces.json", {"forces.csv", "forces.svg", "forces.png"}});
  const std::string json = studies::forces_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) {
    const report::LinePlot plot = report::forces_plot(result);
    files = {{"forces.json", json},
             {"forces.csv", studies::forces_csv(result)},
             {"forces.svg", report::render_svg(plot)},
             {"forces.png", report::render_png(plot)}};
  }
  write_outputs(line.common, json, files, studies::forces_table(result));
  print_warnings(line.common, result.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
