#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "report/results/result_plots.h"
#include "studies/turning/io/turning_files.h"
#include "studies/turning/turn.h"

namespace retrace::app {
namespace {

struct TurnOptions {
  std::string part;
};

std::vector<Argument> arguments(TurnOptions& options) {
  return {part_argument(options.part)};
}

ExitCode run(const TurnOptions& options, const CommonOptions& common) {
  const studies::TurningResult result = studies::turn(options.part);
  ResultFiles files(common, {options.part}, "turning.json");
  for (const studies::TurningText& program : result.programs) files.add(program.file, [&] { return program.text; });
  files.add("servo.csv", [&] { return result.servo_csv; });
  files.add("machined.stl", [&] { return result.machined_stl; });
  files.add("path.csv", [&] { return studies::turning_path_csv(result); });
  files.add("cusps.csv", [&] { return studies::turning_cusps_csv(result); });
  files.add("acceleration.svg", [&] { return report::render_svg(report::turning_acceleration_plot(result)); });
  if (result.check.envelope) {
    files.add("profile.svg", [&] { return report::render_svg(report::turning_profile_plot(result)); });
    files.add("maps.png", [&] { return report::render_png(report::turning_maps(result)); });
  }
  files.prepare();
  return files.write(studies::turning_json(result), studies::turning_table(result), result.part.warnings,
                     {.is_yes = result.passes_inspection()});
}

}  // namespace

Command turn_command() {
  return {.name = "turn",
          .summary = "NC programs of a turned freeform surface, and its deviations",
          .manual =
              "Writes the tool path and the NC programs of a freeform surface that is cut on a lathe, in all dialects. "
              "The programs are read back and the machined surface is compared with the design. Exits with 1 if the "
              "deviation exceeds the tolerances of the part.",
          .reads = {"retrace.turned_part/1"},
          .writes = {"retrace.turning/2"},
          .refuses_set = "not allowed with turn, which reads no design",
          .begin = begins<TurnOptions>(arguments, run)};
}

}  // namespace retrace::app
