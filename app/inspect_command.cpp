#include "app/commands.h"
#include "app/output.h"
#include "report/drawing/design_picture.h"
#include "report/drawing/design_sheets.h"
#include "report/plot.h"
#include "studies/design/design_json.h"
#include "studies/design/design_reader.h"
#include "studies/design/part_of_design.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"

namespace retrace::app {
namespace {

/// The front along two lines through the middle.
std::string profile_svg(const studies::Design& design, const studies::FrontReport& front) {
  report::LinePlot plot;
  plot.title = studies::short_name(design) + ": front";
  plot.x_label = "x, y (mm)";
  plot.y_label = "z (mm)";
  plot.series = {{"along x", front.along_x.place_mm, front.along_x.height_mm, {}},
                 {"along y", front.along_y.place_mm, front.along_y.height_mm, {}}};
  return report::render_svg(plot);
}

/// Plan, section and view of the design; of a curved front its profile in place of section and view, which know plane
/// entrance faces alone; none of balls; of elements on a base the view alone, as their lengths lie in
/// no plane.
std::vector<OutputFile> drawings_of(const studies::Design& design, studies::Inspection& inspection) {
  if (design.balls) return {};  // no part of planes to draw
  if (inspection.front) return {{"front.svg", profile_svg(design, *inspection.front)}};
  if (design.part.base) return {{"view.png", report::view_png(studies::view_of(design))}};
  const studies::DesignDrawing drawing = studies::draw_design(design, studies::part_of_design(design, nullptr));
  std::vector<OutputFile> files = {{"plan.svg", report::plan_svg(drawing)}};
  if (drawing.section) files.push_back({"section.svg", report::section_svg(drawing)});
  files.push_back({"view.png", report::view_png(studies::view_of(design))});
  std::vector<std::string>& warnings = inspection.warnings;
  warnings.insert(warnings.end(), drawing.warnings.begin(), drawing.warnings.end());
  return files;
}

}  // namespace

ExitCode run_inspect_command(const CommandLine& line) {
  const studies::Design design = studies::read_design(line.design, line.common.overrides);
  studies::Inspection inspection = studies::inspect(design, materials::MaterialLibrary::shipped());
  prepare_outputs(line.common,
                  {files_read({design}), "inspect.json", {"plan.svg", "section.svg", "view.png", "front.svg"}});
  std::vector<OutputFile> files;
  if (!line.common.out.empty()) files = drawings_of(design, inspection);
  const std::string json = studies::inspect_json(inspection);
  files.push_back({"inspect.json", json});
  write_outputs(line.common, json, files, studies::inspect_text(inspection));
  print_warnings(line.common, inspection.warnings);
  return ExitCode::done;
}

}  // namespace retrace::app
