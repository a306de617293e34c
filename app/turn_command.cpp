#include "app/commands.h"
#include "app/output.h"
#include "report/turning_plot.h"
#include "studies/turning/io/turning_files.h"
#include "studies/turning/turn.h"

namespace retrace::app {

ExitCode run_turn_command(const CommandLine& line) {
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "turn reads no design");
  const studies::TurningResult result = studies::turn(line.turn_part);
  std::vector<OutputFile> files;
  const std::string json = studies::turning_json(result);
  if (!line.common.out.empty()) {
    for (const studies::TurningText& program : result.programs) files.push_back({program.file, program.text});
    if (!result.servo_csv.empty()) files.push_back({"servo.csv", result.servo_csv});
    if (!result.machined_stl.empty()) files.push_back({"machined.stl", result.machined_stl});
    files.push_back({"path.csv", studies::turning_path_csv(result)});
    files.push_back({"cusps.csv", studies::turning_cusps_csv(result)});
    files.push_back({"acceleration.svg", report::render_svg(report::turning_acceleration_plot(result))});
    files.push_back({"profile.svg", report::render_svg(report::turning_profile_plot(result))});
    files.push_back({"maps.png", report::render_png(report::turning_maps(result))});
  }
  FileNames names{{line.turn_part}, "turning.json", {}};
  for (const OutputFile& file : files) names.others.push_back(file.name);
  prepare_outputs(line.common, names);
  files.push_back({"turning.json", json});
  write_outputs(line.common, json, files, studies::turning_table(result));
  print_warnings(line.common, result.part.warnings);
  return result.passes_inspection() ? ExitCode::done : ExitCode::answer_is_no;
}

}  // namespace retrace::app
