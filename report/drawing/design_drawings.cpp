#include "report/drawing/design_drawings.h"

#include "design/io/design_json.h"
#include "design/part_of_design.h"
#include "report/drawing/design_picture.h"
#include "report/drawing/design_sheets.h"
#include "report/plot.h"

namespace retrace::report {
namespace {

/// Returns the profile of a curved entrance face along two lines through its centre.
std::string profile_svg(const design::Design& design, const studies::EntranceReport& entrance) {
  LinePlot plot;
  plot.title = design::short_name(design) + ": entrance surface";
  plot.x_label = "x, y (mm)";
  plot.y_label = "z (mm)";
  plot.series = {{"along x", entrance.along_x.position_mm, entrance.along_x.height_mm, {}},
                 {"along y", entrance.along_y.position_mm, entrance.along_y.height_mm, {}}};
  return render_svg(plot);
}

}  // namespace

DesignDrawings design_drawings(const studies::Inspection& inspection) {
  const design::Design& design = inspection.design;
  if (design.balls()) return {};  // balls have no plane facets, but the drawings show planes
  if (inspection.entrance) return {.entrance = profile_svg(design, *inspection.entrance)};
  if (design.elements() && design.part().substrate) return {.view = view_png(studies::view_of(design))};
  const studies::DesignDrawing drawing = studies::draw_design(design, design::part_of_design(design, nullptr));
  return {.plan = plan_svg(drawing),
          .section = drawing.section ? section_svg(drawing) : "",
          .view = view_png(studies::view_of(design)),
          .warnings = drawing.warnings};
}

}  // namespace retrace::report
