#include "report/drawing/design_drawings.h"

#include <fmt/format.h>

#include <vector>

#include "core/number_format.h"
#include "design/entrance_of_design.h"
#include "design/io/design_json.h"
#include "design/part_of_design.h"
#include "report/drawing/design_picture.h"
#include "report/drawing/design_sheets.h"
#include "report/plot.h"

namespace retrace::report {
namespace {

/// Smallest factor of the heights, relative to lengths, by which a drawing is called exaggerated.
constexpr double kExaggerated = 1.0 + 1e-9;

/// Returns the largest factor of 1, 2 or 5 times a power of ten with which heights of the given span fit the plot.
double exaggeration_for(double height_mm, double length_mm) {
  constexpr double kFilled = 0.92;  // fraction of the plot's height that the heights may fill
  return previous_round_number(kFilled * kPlotAreaHeight / kPlotAreaWidth * length_mm / height_mm);
}

/// Returns the profile of a curved entrance face along two lines through its centre. The scale of the heights is
/// stated.
std::string profile_svg(const design::Design& design, const studies::EntranceReport& entrance) {
  LinePlot plot;
  plot.title = design::short_name(design) + ": entrance surface";
  plot.x_label = "x, y (mm)";
  plot.y_label = "z (mm)";
  plot.series = {{"along x", entrance.along_x.position_mm, entrance.along_x.height_mm, {}},
                 {"along y", entrance.along_y.position_mm, entrance.along_y.height_mm, {}}};
  std::vector<double> x;
  std::vector<double> z;
  for (const Series& series : plot.series) {
    x.insert(x.end(), series.x.begin(), series.x.end());
    z.insert(z.end(), series.y.begin(), series.y.end());
  }
  const Range lengths = drawable(extent_of(x).value_or(Range{0.0, 1.0}));
  const Range heights = drawable(extent_of(z).value_or(Range{0.0, 1.0}));
  const double factor = exaggeration_for(heights.span(), lengths.span());
  const double half_mm = 0.5 * kPlotAreaHeight / kPlotAreaWidth * lengths.span() / factor;
  const double middle_mm = 0.5 * (heights.low + heights.high);
  plot.x_range = lengths;
  plot.y_range = Range{middle_mm - half_mm, middle_mm + half_mm};
  plot.y_label += factor > kExaggerated ? fmt::format(", heights exaggerated {} times", shortest(factor))
                  : factor < 1.0        ? fmt::format(", heights reduced to {} times", shortest(factor))
                                        : ", to scale";
  return render_svg(plot);
}

}  // namespace

DesignDrawings design_drawings(const studies::Inspection& inspection) {
  const design::Design& design = inspection.design;
  if (design.balls()) return {};  // balls have no plane facets, but the drawings show planes
  if (inspection.entrance) {
    const geometry::Part part = design::part_of_design(design, nullptr);
    const auto heights = studies::heights_of(design::entrance_of_design(design, part), part);
    // On a substrate, a section cannot show the true lengths of elements.
    const bool has_section = !design.elements() || !design.part().substrate;
    const studies::DesignDrawing drawing =
        has_section ? studies::draw_curved_design(design, part, heights) : studies::draw_plan(design, part);
    return {.plan = plan_svg(drawing),
            .section = drawing.section ? section_svg(drawing) : "",
            .view = view_png(studies::view_of(design, part, heights)),
            .entrance = profile_svg(design, *inspection.entrance),
            .warnings = drawing.warnings};
  }
  if (design.elements() && design.part().substrate) return {.view = view_png(studies::view_of(design))};
  const studies::DesignDrawing drawing = studies::draw_design(design, design::part_of_design(design, nullptr));
  return {.plan = plan_svg(drawing),
          .section = drawing.section ? section_svg(drawing) : "",
          .view = view_png(studies::view_of(design)),
          .warnings = drawing.warnings};
}

}  // namespace retrace::report
