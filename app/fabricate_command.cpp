#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "fabrication/post/post.h"
#include "report/fabrication_plot.h"
#include "studies/fabrication/fabricate.h"
#include "studies/fabrication/io/fabrication_files.h"

namespace retrace::app {
namespace {

void add_picture(std::vector<OutputFile>& files, const std::string& name, const auto& plot) {
  files.push_back({name + ".svg", report::render_svg(plot)});
  files.push_back({name + ".png", report::render_png(plot)});
}

bool has_stage(const studies::FabricationResult& result, bool roughing) {
  for (const auto& stage : result.plan.stages)
    if (stage.roughs == roughing) return true;
  return false;
}

}  // namespace

ExitCode run_fabricate_command(const CommandLine& line) {
  if (!line.common.overrides.empty())
    throw InputError({"", 0, "--set"}, "fabricate reads no design; change the job file, or make it anew");
  studies::FabricationRequest request;
  request.job_file = line.fabricate.job;
  request.dialect = line.fabricate.dialect;
  request.options.phase = line.fabricate.phase;
  request.options.from_element = line.fabricate.from_element;
  request.options.stop_every = line.fabricate.stop_every;
  request.options.split_hours = line.fabricate.split_hours;
  const studies::FabricationResult result = studies::fabricate(request);

  std::vector<OutputFile> files;
  const std::string json = studies::fabrication_json(result);
  if (!line.common.out.empty()) {
    files = {{"fabrication.json", json}, {"stages.csv", studies::stages_csv(result)}};
    for (const bool roughing : {true, false})
      if (has_stage(result, roughing))
        add_picture(files, roughing ? "roughing" : "finishing", report::tool_path_plot(result, roughing));
    add_picture(files, "arrangement", report::arrangement_plot(result));
    for (std::size_t k = 0; k < result.plan.programs.size(); ++k)
      files.push_back({result.program_file(k), fabrication::nc_text(result.plan.programs[k], result.dialect)});
  }
  FileNames names{{line.fabricate.job}, "fabrication.json", {}};
  if (std::filesystem::path(result.job.machine).has_extension()) names.inputs.push_back(result.job.machine);
  for (const OutputFile& file : files)
    if (file.name != "fabrication.json") names.others.push_back(file.name);
  prepare_outputs(line.common, names);
  write_outputs(line.common, json, files, studies::fabrication_table(result));
  print_warnings(line.common, result.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
