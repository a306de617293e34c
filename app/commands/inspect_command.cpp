#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "report/drawing/design_picture.h"
#include "report/drawing/design_sheets.h"
#include "report/plot.h"
#include "studies/design/io/design_json.h"
#include "studies/design/io/design_reader.h"
#include "studies/design/part_of_design.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"

namespace retrace::app {
namespace {

struct InspectOptions {
  std::string design;
};

std::vector<Argument> arguments(InspectOptions& options) {
  return {design_argument(options.design)};
}

/// The front along two lines through the middle.
std::string profile_svg(const studies::Design& design, const studies::EntranceReport& entrance) {
  report::LinePlot plot;
  plot.title = studies::short_name(design) + ": front";
  plot.x_label = "x, y (mm)";
  plot.y_label = "z (mm)";
  plot.series = {{"along x", entrance.along_x.place_mm, entrance.along_x.height_mm, {}},
                 {"along y", entrance.along_y.place_mm, entrance.along_y.height_mm, {}}};
  return report::render_svg(plot);
}

/// Contents of the drawings; those that a design has not are empty.
struct Drawings {
  std::string plan = {};
  std::string section = {};
  std::string view = {};
  std::string entrance = {};
};

/// Plan, section and view of the design; of a curved front its profile in place of section and view, which know plane
/// entrance faces alone; none of balls; of elements on a base the view alone, as their lengths lie in
/// no plane.
Drawings drawings_of(const studies::Design& design, studies::Inspection& inspection) {
  if (design.balls()) return {};  // no part of planes to draw
  if (inspection.entrance) return {.entrance = profile_svg(design, *inspection.entrance)};
  if (design.elements() && design.part().substrate) return {.view = report::view_png(studies::view_of(design))};
  const studies::DesignDrawing drawing = studies::draw_design(design, studies::part_of_design(design, nullptr));
  std::vector<std::string>& warnings = inspection.warnings;
  warnings.insert(warnings.end(), drawing.warnings.begin(), drawing.warnings.end());
  return {.plan = report::plan_svg(drawing),
          .section = drawing.section ? report::section_svg(drawing) : "",
          .view = report::view_png(studies::view_of(design))};
}

ExitCode run(const InspectOptions& options, const CommonOptions& common) {
  const studies::Design design = studies::read_design(options.design, common.overrides);
  studies::Inspection inspection = studies::inspect(design, materials::MaterialLibrary::shipped());
  Drawings drawings;
  ResultFiles files(common, files_read({design}), "inspect.json");
  files.add("plan.svg", [&] { return drawings.plan; });
  files.add("section.svg", [&] { return drawings.section; });
  files.add("view.png", [&] { return drawings.view; });
  files.add("front.svg", [&] { return drawings.entrance; });
  files.prepare();
  if (!common.out.empty()) drawings = drawings_of(design, inspection);
  return files.write(studies::inspect_json(inspection), studies::inspect_text(inspection), inspection.warnings);
}

}  // namespace

Command inspect_command() {
  return {.name = "inspect",
          .summary = "what a design is: counts, areas, limits of total reflection; its drawings",
          .manual =
              "What a design is, before any light is traced: counts, areas, depth, limits of total reflection, "
              "and whether its boundary is closed; drawings of its plan, its section and in three dimensions.",
          .reads = {"retrace.design/1"},
          .writes = {"retrace.inspect/1"},
          .begin = begins<InspectOptions>(arguments, run)};
}

}  // namespace retrace::app
