#include <array>
#include <utility>

#include "app/commands.h"
#include "app/output.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "design/io/design_reader.h"
#include "report/drawing/design_drawings.h"
#include "requests/descriptions.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"

namespace retrace::app {
namespace {

struct InspectOptions {
  std::string design;
  FieldTexts fields;
};

std::vector<Argument> arguments(InspectOptions& options) {
  std::vector<Argument> all = {design_argument(options.design)};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<InspectRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

ExitCode run(const InspectOptions& options, const CommonOptions& common) {
  const auto request = request_of<InspectRequest>(options.fields, common);
  const design::Design design = design::read_design(options.design, common.overrides);
  studies::Inspection inspection = studies::inspect(design, materials::MaterialLibrary::shipped(), request);
  report::DesignDrawings drawings;
  ResultFiles files(common, files_read({design}), "inspect.json");
  files.add("plan.svg", [&] { return drawings.plan; });
  files.add("section.svg", [&] { return drawings.section; });
  files.add("view.png", [&] { return drawings.view; });
  files.add("entrance_surface.svg", [&] { return drawings.entrance; });
  files.add("shells.svg", [&] { return drawings.shells; });
  files.add("pin_axes.svg", [&] { return drawings.pin_axes; });
  files.add("pin_axes.csv", [&] { return studies::pin_axes_csv(inspection); });
  files.add("draft.csv", [&] { return studies::draft_csv(inspection); });
  files.prepare();
  if (!common.out.empty()) drawings = report::design_drawings(inspection);
  append(inspection.warnings, drawings.warnings);
  return files.write(studies::inspect_json(inspection), studies::inspect_text(inspection), inspection.warnings);
}

}  // namespace

Command inspect_command() {
  return {.name = "inspect",
          .summary = "counts, areas, limits of total reflection, walls, draft and drawings of a design",
          .manual =
              "Describes a design without tracing light: counts, areas, depth, limits of total reflection, and whether "
              "its boundary is closed. For the toolmaker, it gives the smallest wall, the draft along the demoulding "
              "direction, undercuts and the axes of the elements. Draws its plan, its section and a three-dimensional "
              "view.",
          .reads = {"retrace.design/1"},
          .writes = {"retrace.inspect/2"},
          .begin = begins<InspectOptions>(arguments, run)};
}

}  // namespace retrace::app
