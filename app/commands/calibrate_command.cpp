#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "studies/calibration/io/calibration_files.h"
#include "studies/calibration/io/measurement_reader.h"

namespace retrace::app {
namespace {

struct CalibrateOptions {
  std::string measurements;
};

std::vector<Argument> arguments(CalibrateOptions& options) {
  return {{"MEASUREMENTS", "table of what was measured of parts that the machine cut", &options.measurements,
           files(".csv")}};
}

std::vector<std::string> inputs_of(const CalibrateOptions& options, const studies::MeasuredParts& parts) {
  std::vector<std::string> inputs = {options.measurements};
  for (const studies::FabricationResult& plan : parts.plans) {
    inputs.push_back(plan.job.source);
    if (std::filesystem::path(plan.job.machine).has_extension()) inputs.push_back(plan.job.machine);
  }
  return inputs;
}

ExitCode run(const CalibrateOptions& options, const CommonOptions& common) {
  studies::MeasuredParts parts = studies::read_measurements(options.measurements);
  ResultFiles files(common, inputs_of(options, parts), "calibration.json");
  const studies::Calibration result = studies::calibrate(std::move(parts));
  files.add("machine.toml", [&] { return studies::calibrated_machine_toml(result); });
  files.add("residuals.csv", [&] { return studies::residuals_csv(result); });
  files.prepare();
  return files.write(studies::calibration_json(result), studies::calibration_table(result), result.warnings);
}

}  // namespace

Command calibrate_command() {
  return {.name = "calibrate",
          .summary = "where a machine's axes are, from what was measured of parts that it cut",
          .manual =
              "Estimates, from depths, distances and angles of facets, by how much a machine differs from its file: "
              "centres and directions of its axes, squareness, how the tool stands - each with its uncertainty -, says "
              "which of them the measurements do not tell apart and which measurements the others contradict, and "
              "writes machine.toml, for which the next programs are made.",
          .reads = {"table of measurements (CSV)", "retrace.job/1", "retrace.machine/1"},
          .writes = {"retrace.calibration/1", "retrace.machine/1"},
          .refuses_set = "calibrate reads no design",
          .begin = begins<CalibrateOptions>(arguments, run)};
}

}  // namespace retrace::app
