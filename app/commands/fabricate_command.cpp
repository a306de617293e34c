#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "app/commands.h"
#include "app/output.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "fabrication/post/post.h"
#include "report/page/setup_page.h"
#include "report/results/result_plots.h"
#include "requests/descriptions.h"
#include "studies/fabrication/fabricate.h"
#include "studies/fabrication/io/fabrication_files.h"
#include "studies/setup/io/setup_files.h"
#include "studies/setup/setup_sheet.h"

namespace retrace::app {
namespace {

struct FabricateOptions {
  std::string job;
  FieldTexts fields;
};

std::vector<Argument> arguments(FabricateOptions& options) {
  std::vector<Argument> all = {job_argument(options.job, "job file, as retrace job writes it")};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<FabricationRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) {
    if (option_names(argument).front() == requests::option_of_field("phase"))
      argument.traits.words = one_of({"all", "roughing", "finishing"}).words;
    all.push_back(std::move(argument));
  }
  return all;
}

bool has_stage(const studies::FabricationResult& result, bool roughing) {
  for (const auto& stage : result.plan.stages)
    if (stage.roughs == roughing) return true;
  return false;
}

/// Returns the drawings for the set-up sheet. Each drawing is a separate SVG document, because different drawings can
/// contain equal XML ids.
std::vector<report::PageFigure> drawings_of(const studies::FabricationResult& result) {
  std::vector<report::PageFigure> figures;
  const auto add = [&](const std::string& caption, const std::string& svg) {
    figures.push_back({caption, "", "image/svg+xml", svg, caption});
  };
  add("The elements, in the order in which they are cut", report::render_svg(report::arrangement_plot(result)));
  for (const bool roughing : {true, false})
    if (has_stage(result, roughing))
      add(fmt::format("Tool path through one element: {}", roughing ? "roughing" : "finishing"),
          report::render_svg(report::tool_path_plot(result, roughing)));
  return figures;
}

ExitCode run(const FabricateOptions& options, const CommonOptions& common) {
  const studies::FabricationResult result =
      studies::fabricate(options.job, request_of<FabricationRequest>(options.fields, common));
  // The sheet can also show how machining errors change the returned light. This requires ray tracing, which is done
  // only if the sheet is written to a file or to JSON.
  const studies::SetupSheet sheet = studies::setup_sheet(result, !common.out.empty() || !common.json.empty());

  std::vector<std::string> inputs = {options.job};
  if (std::filesystem::path(result.job.machine).has_extension()) inputs.push_back(result.job.machine);
  ResultFiles files(common, inputs, "fabrication.json");
  files.add("stages.csv", [&] { return studies::stages_csv(result); });
  for (const bool roughing : {true, false})
    if (has_stage(result, roughing))
      files.add_drawing(roughing ? "roughing" : "finishing",
                        [&result, roughing] { return report::tool_path_plot(result, roughing); });
  files.add_drawing("arrangement", [&] { return report::arrangement_plot(result); });
  for (std::size_t k = 0; k < result.plan.programs.size(); ++k)
    files.add(result.program_file(k),
              [&result, k] { return fabrication::nc_text(result.plan.programs[k], result.dialect); });
  files.add("setup.html", [&] { return report::setup_html(report::setup_page(result, sheet, drawings_of(result))); });
  files.prepare();
  Warnings warnings = result.warnings;
  append(warnings, sheet.warnings);
  return files.write(studies::fabrication_json(result, studies::setup_json(result, sheet)),
                     studies::fabrication_table(result), warnings);
}

}  // namespace

Command fabricate_command() {
  return {.name = "fabricate",
          .summary = "NC programs, set-up, tool path and time of a fabrication job",
          .manual =
              "Plans a job and writes its NC programs, drawings of the tool path, the machining time, and setup.html, "
              "a set-up sheet for the operator of the machine: blank, tool, zero, axes, control, measurements, and the "
              "effect of each set-up error. Long jobs can be split into several programs, and restarted at an element "
              "or a stage.",
          .reads = {"retrace.job/1", "retrace.machine/1"},
          .writes = {"retrace.fabrication/2"},
          .refuses_set =
              "not allowed with fabricate, which reads no design; change the job, or make a new one with retrace job",
          .begin = begins<FabricateOptions>(arguments, run)};
}

}  // namespace retrace::app
