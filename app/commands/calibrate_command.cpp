#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "core/error.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "studies/calibration/io/calibration_files.h"
#include "studies/calibration/io/measurement_reader.h"
#include "studies/calibration/io/time_files.h"
#include "studies/calibration/time_programs.h"

namespace retrace::app {
namespace {

struct CalibrateOptions {
  std::optional<std::string> measurements;
  /// Machine on which programs were timed; if empty, the table contains measurements of parts instead of times.
  std::string times;
  std::string dialect = "rs274ngc";
};

std::vector<Argument> arguments(CalibrateOptions& options) {
  std::vector<Argument> all = {
      {"MEASUREMENTS", "table with measurements of parts that the machine cut", &options.measurements, files(".csv")},
      {"--times MACHINE",
       "estimate the acceleration and settling of the axes of this machine (name or file). MEASUREMENTS then contains "
       "run times of programs; without it, the programs to be timed are written",
       &options.times, machine_traits()}};
  all.push_back(dialect_argument(options.dialect));
  // The dialect is needed only for writing programs. Programs are written if --times is given without a table.
  all.back().traits.needs = {any_given({"--times"}), absent("MEASUREMENTS")};
  return all;
}

std::vector<std::string> inputs_of(const CalibrateOptions& options, const studies::MeasuredParts& parts) {
  std::vector<std::string> inputs = {*options.measurements};
  for (const studies::FabricationResult& plan : parts.plans) {
    inputs.push_back(plan.job.source);
    if (std::filesystem::path(plan.job.machine).has_extension()) inputs.push_back(plan.job.machine);
  }
  return inputs;
}

/// Writes NC programs that are to be timed on the machine, and a table in which the user enters the measured times.
ExitCode write_time_programs(const CalibrateOptions& options, const CommonOptions& common,
                             const fabrication::Machine& machine) {
  if (common.out.empty())
    throw InputError({"", 0, "MEASUREMENTS"},
                     "is required; without it, give --out FOLDER to write the programs to be timed");
  const std::vector<fabrication::Program> programs = studies::time_programs(machine, options.dialect);
  ResultFiles files(common, {options.times});
  std::vector<std::string> names;
  for (const fabrication::Program& program : programs) {
    names.push_back(program.name + std::string(fabrication::ending_of(options.dialect)));
    files.add(names.back(), [&] { return fabrication::nc_text(program, options.dialect); });
  }
  files.add("times.csv", [&] { return studies::times_csv(names); });
  files.prepare();
  return files.write(studies::time_programs_json(machine, names),
                     "Wrote programs to be timed; they do not cut. Enter their run times in times.csv.\n");
}

/// Estimates the acceleration and settling of the axes from measured times of programs. Without a table of times,
/// writes the programs to be timed.
ExitCode calibrate_times(const CalibrateOptions& options, const CommonOptions& common) {
  const fabrication::Machine machine = fabrication::load_machine(options.times, {"", 0, "--times"});
  if (!options.measurements) return write_time_programs(options, common, machine);
  studies::TimedPrograms programs = studies::read_times(*options.measurements, machine);
  std::vector<std::string> inputs = {*options.measurements};
  if (std::filesystem::path(options.times).has_extension()) inputs.push_back(options.times);
  for (const studies::TimedMoves& row : programs.rows)
    inputs.push_back((std::filesystem::path(*options.measurements).parent_path() / row.program).string());
  ResultFiles files(common, inputs, "time_calibration.json");
  const studies::TimeCalibration result = studies::calibrate_times(std::move(programs), machine);
  files.add("machine.toml", [&] { return fabrication::machine_text(result.machine); });
  files.prepare();
  return files.write(studies::time_calibration_json(result), studies::time_calibration_table(result), result.warnings);
}

ExitCode run(const CalibrateOptions& options, const CommonOptions& common) {
  if (!options.times.empty()) return calibrate_times(options, common);
  if (!options.measurements) throw InputError({"", 0, "MEASUREMENTS"}, "is required");
  studies::MeasuredParts parts = studies::read_measurements(*options.measurements);
  ResultFiles files(common, inputs_of(options, parts), "calibration.json");
  const studies::Calibration result = studies::calibrate(std::move(parts));
  files.add("machine.toml", [&] { return fabrication::machine_text(result.machine); });
  files.add("residuals.csv", [&] { return studies::residuals_csv(result); });
  files.prepare();
  return files.write(studies::calibration_json(result), studies::calibration_table(result), result.warnings);
}

}  // namespace

Command calibrate_command() {
  return {.name = "calibrate",
          .summary = "positions and directions of a machine's axes, from measurements of parts that it cut",
          .manual =
              "Estimates, from depths, distances and angles of facets, how a machine differs from its file: centres "
              "and directions of its axes, squareness, and the position of the tool, each with its uncertainty. "
              "Reports which of these quantities the measurements cannot separate, and which measurements contradict "
              "the others. Writes machine.toml, the machine file for further programs. With --times, estimates the "
              "acceleration and settling of the axes from run times of programs.",
          .reads = {"table of measurements (CSV)", "table of times (CSV)", "retrace.job/1", "retrace.machine/1",
                    "NC program"},
          .writes = {"retrace.calibration/2", "retrace.time_calibration/2", "retrace.time_programs/1",
                     "retrace.machine/1", "NC program", "table of times (CSV)"},
          .refuses_set = "not allowed with calibrate, which reads no design",
          .begin = begins<CalibrateOptions>(arguments, run)};
}

}  // namespace retrace::app
