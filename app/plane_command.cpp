#include "app/commands.h"
#include "app/output.h"
#include "report/planing_plot.h"
#include "studies/planing/io/planing_files.h"
#include "studies/planing/planing_study.h"

namespace retrace::app {
namespace {

void add_plot(std::vector<OutputFile>& files, const std::string& name, const report::LinePlot& plot) {
  files.push_back({name + ".svg", report::render_svg(plot)});
  files.push_back({name + ".png", report::render_png(plot)});
}

std::vector<OutputFile> files_of(const studies::PlaningResult& result, const std::string& json) {
  std::vector<OutputFile> files = {{"planing.json", json}};
  add_plot(files, "profile", report::planing_profile_plot(result));
  add_plot(files, "zones", report::planing_zones_plot(result));
  if (result.part.mill) {
    files.push_back({"profile.csv", studies::planing_csv(result)});
    add_plot(files, "form_error", report::planing_error_plot(result));
  }
  for (const fabrication::PlaningText& program : result.programs) files.push_back({program.name, program.text});
  return files;
}

}  // namespace

ExitCode run_plane_command(const CommandLine& line) {
  if (!line.common.overrides.empty()) throw InputError({"", 0, "--set"}, "plane reads no design: change the part file");
  const studies::PlaningResult result = studies::plane(line.fabricate.job, line.fabricate.dialect);
  const std::string json = studies::planing_json(result);
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = files_of(result, json);
  FileNames names{{line.fabricate.job}, "planing.json", {}};
  for (const OutputFile& file : files)
    if (file.name != "planing.json") names.others.push_back(file.name);
  prepare_outputs(line.common, names);
  write_outputs(line.common, json, files, studies::planing_table(result));
  print_warnings(line.common, result.warnings);
  return result.check.passes() ? ExitCode::done : ExitCode::answer_is_no;
}

}  // namespace retrace::app
