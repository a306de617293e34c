#include "report/drawing/design_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/number_format.h"
#include "design/entrance_of_design.h"
#include "design/io/design_json.h"
#include "design/part_of_design.h"
#include "geometry/outline/convex_decomposition.h"
#include "report/drawing/design_picture.h"
#include "report/drawing/design_sheets.h"
#include "report/map_plot.h"
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

/// Returns the section through the shells and the part. Lengths along both axes have the same scale.
std::string shells_svg(const design::Design& design, const studies::ShellSection& section) {
  LinePlot plot;
  plot.title = design::short_name(design) + ": shells in front of the part";
  plot.x_label = section.is_along_y ? "y (mm)" : "x (mm)";
  plot.y_label = "z (mm), to scale";
  std::vector<double> x;
  std::vector<double> z;
  const auto add = [&](const std::string& label, const std::vector<geometry::Vec2>& line) {
    Series& series = plot.series.emplace_back(Series{.label = label, .x = {}, .y = {}, .y_error = {}});
    for (const geometry::Vec2& point : line) series.add(point.x(), point.y());
    x.insert(x.end(), series.x.begin(), series.x.end());
    z.insert(z.end(), series.y.begin(), series.y.end());
  };
  for (std::size_t k = 0; k < section.shells.size(); ++k) add(fmt::format("shell {}", k + 1), section.shells[k]);
  add("part", section.part);
  // The scale is the same for both axes. The axis that needs the smaller scale determines it.
  const Range lengths = drawable(extent_of(x).value_or(Range{0.0, 1.0}));
  const Range heights = drawable(extent_of(z).value_or(Range{0.0, 1.0}));
  constexpr double kFilledLength = 0.92;
  const double mm_per_unit =
      std::max(lengths.span() / kPlotAreaWidth, heights.span() / kPlotAreaHeight) / kFilledLength;
  const auto around = [](const Range& range, double half) {
    const double middle = 0.5 * (range.low + range.high);
    return Range{middle - half, middle + half};
  };
  plot.x_range = around(lengths, 0.5 * kPlotAreaWidth * mm_per_unit);
  plot.y_range = around(heights, 0.5 * kPlotAreaHeight * mm_per_unit);
  return render_svg(plot);
}

/// Returns a map of the angles between the axes of the elements and the normal of the entrance face.
std::string pin_axes_svg(const studies::ToolReport& tool) {
  MapPlot plot;
  plot.title = "Axes of the elements and normal of the entrance surface";
  plot.axis_unit = "mm";
  plot.value_label = "angle (degrees)";
  plot.hatched_label = "no whole element";
  MapPanel& panel = plot.panels.emplace_back();
  std::vector<geometry::Vec2> corners;
  double largest_deg = 0.0;
  for (const studies::PinAxis& pin : tool.pin_axes) {
    panel.regions.push_back({pin.outline_mm, pin.angle_deg()});
    largest_deg = std::max(largest_deg, pin.angle_deg());
    corners.insert(corners.end(), pin.outline_mm.begin(), pin.outline_mm.end());
  }
  panel.outline = geometry::convex_hull(std::move(corners));
  plot.full_value = std::max(largest_deg, 1e-3);
  return render_svg(plot);
}

/// Returns the drawings of the part itself.
DesignDrawings part_drawings(const studies::Inspection& inspection) {
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

}  // namespace

DesignDrawings design_drawings(const studies::Inspection& inspection) {
  DesignDrawings drawings = part_drawings(inspection);
  if (inspection.shells) drawings.shells = shells_svg(inspection.design, inspection.shells->section);
  if (inspection.tool && !inspection.tool->pin_axes.empty()) drawings.pin_axes = pin_axes_svg(*inspection.tool);
  return drawings;
}

}  // namespace retrace::report
