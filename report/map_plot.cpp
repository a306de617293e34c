#include "report/map_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "report/style.h"

namespace retrace::report {
namespace {

using geometry::Polygon, geometry::Rectangle, geometry::Vec2;

constexpr Colour kRest{0.945, 0.945, 0.945};
constexpr Colour kHatch{0.80, 0.80, 0.80};
constexpr Colour kLine{0.55, 0.55, 0.55};  ///< grey that is visible on the palest and on the darkest region

// Colour scale YlGnBu of ColorBrewer (Harrower and Brewer 2003), from dark to light: as in all maps, lighter means
// more. Its lightness changes monotonically, and it is suitable for colour-blind readers.
constexpr ColourScale kMapScale = {{{0.031, 0.114, 0.345},
                                    {0.145, 0.204, 0.580},
                                    {0.133, 0.369, 0.659},
                                    {0.114, 0.569, 0.753},
                                    {0.255, 0.714, 0.769},
                                    {0.498, 0.804, 0.733},
                                    {0.780, 0.914, 0.706},
                                    {0.929, 0.973, 0.694},
                                    {1.000, 1.000, 0.851}}};
constexpr int kColourSteps = 200;

constexpr Font kMapRemarkFont{11.0, false};
constexpr Font kMapLabelFont{13.0, false};
constexpr Font kMapTickFont{11.0, false};

constexpr double kMapTickLength = 4.0;
constexpr AxisStyle kMapAxis{.font = kMapTickFont,
                             .tick = kMapTickLength,
                             .x_label_gap = kMapTickLength + 3.0 + kMapTickFont.size,
                             .y_label_gap = kMapTickLength + 3.0,
                             .baseline = 0.36 * kMapTickFont.size};
constexpr AxisStyle kMapBarAxis{.font = kMapTickFont,
                                .tick = kMapTickLength,
                                .y_label_gap = kMapTickLength + 4.0,
                                .baseline = 0.36 * kMapTickFont.size,
                                .width = 0.9};
constexpr double kPlanLeft = 40.0;  ///< distance of the plan from the left end of its cell, for the labels of the axis
constexpr double kMapBarWidth = 16.0, kHatchSpacing = 6.0;
/// Distance by which regions are enlarged. Without it, the background would be visible between the anti-aliased edges
/// of adjacent regions.
constexpr double kSwell = 0.15;
/// Width of the surroundings that are shown around a periodic outline, in periods, and the opacity of the white layer
/// over them.
constexpr double kSurroundings = 0.3, kSurroundingsVeil = 0.62;
/// Minimum distance of thin lines. Closer lines are not drawn.
constexpr double kMinLineDistance = 3.0;

/// Returns the rectangle of the plane that a panel shows.
Rectangle shown_by(const MapPanel& panel) {
  if (panel.outline.empty()) return {Vec2::Zero(), Vec2::Ones()};
  Rectangle box = geometry::bounding_box(panel.outline);
  if (!panel.is_periodic) return box;
  // The width is the same on all sides, so that an oblong period does not appear truncated.
  const Vec2 around = Vec2::Constant(kSurroundings * box.size().minCoeff());
  return {box.lower - around, box.upper + around};
}

/// Dimensions that are the same for all panels.
struct MapLayout {
  std::size_t columns = 1;
  std::size_t rows = 1;
  Size box;           ///< size of the largest plan
  Size cell;          ///< size of a panel with its texts
  double head = 0.0;  ///< height of the texts above a plan
  double left = 0.0;
  double top = 0.0;
  Range values;
  Ticks value_ticks;
  double bar_left = 0.0;
  double bar_top = 0.0;
  double bar_height = 0.0;
  Size figure;
};

double plan_width(std::size_t panels) {
  if (panels == 1) return 460.0;
  if (panels <= 4) return 320.0;
  return panels <= 9 ? 240.0 : 180.0;
}

std::size_t columns_for(std::size_t panels) {
  if (panels <= 3) return std::max<std::size_t>(1, panels);
  if (panels == 4) return 2;
  return panels <= 9 ? 3 : panels <= 16 ? 4 : 6;
}

Range value_range(const MapPlot& plot) {
  double most = 0.0;
  for (const MapPanel& panel : plot.panels)
    for (const MapRegion& region : panel.regions) most = std::max(most, region.value);
  if (most > 0.5 * plot.full_value || most <= 0.0) return {0.0, plot.full_value};
  return rounded_range({0.0, most}, {0.0, most}, 5);
}

/// Returns the height of the boxes for plans of a given width. It is the height of the tallest plan, up to a maximum.
double plan_height(const MapPlot& plot, double width) {
  double aspect = 0.0;
  for (const MapPanel& panel : plot.panels) {
    const Vec2 size = shown_by(panel).size();
    aspect = std::max(aspect, size.y() / size.x());
  }
  return width * std::clamp(plot.panels.empty() ? 1.0 : aspect, 0.12, 1.25);
}

MapLayout lay_out(const MapPlot& plot, const Canvas& canvas) {
  MapLayout layout;
  const std::size_t count = plot.panels.size();
  layout.columns = columns_for(count);
  layout.rows = std::max<std::size_t>(1, (count + layout.columns - 1) / layout.columns);
  layout.box.width = plan_width(count);
  layout.box.height = plan_height(plot, layout.box.width);
  std::size_t remarks = 0;
  for (const MapPanel& panel : plot.panels) remarks = std::max(remarks, panel.remarks.size());
  layout.head = kPanelFont.size + 11.0 + (kMapRemarkFont.size + 5.0) * static_cast<double>(remarks);
  layout.cell = {layout.box.width + 58.0, layout.box.height + layout.head + kMapTickLength + kMapTickFont.size + 26.0};
  layout.values = value_range(plot);
  layout.value_ticks = make_ticks(layout.values, 5);
  layout.left = kMargin + kMapLabelFont.size + 4.0;

  const double grid_width = layout.cell.width * static_cast<double>(layout.columns);
  const double grid_height = layout.cell.height * static_cast<double>(layout.rows);
  double label_width = 0.0;
  for (const std::string& label : layout.value_ticks.labels)
    label_width = std::max(label_width, canvas.text_width(label, kMapTickFont));
  layout.bar_left = layout.left + grid_width + 14.0;
  layout.figure.width = std::ceil(layout.bar_left + kMapBarWidth + kMapTickLength + 6.0 +
                                  std::max(label_width + 8.0 + kMapLabelFont.size,
                                           canvas.text_width(plot.hatched_label, kMapTickFont) - kMapTickLength) +
                                  kMargin);
  const std::size_t title = title_lines(plot.title, layout.figure.width).size();
  layout.top = kMargin + kTitleLineHeight * static_cast<double>(title) + 4.0;
  layout.bar_height = std::min(320.0, std::max(150.0, layout.box.height) - 34.0);
  layout.bar_top = layout.top + layout.head;
  const double bar_bottom = layout.bar_top + layout.bar_height + 34.0;
  layout.figure.height = std::ceil(std::max(layout.top + grid_height + kMapLabelFont.size - 4.0, bar_bottom) + kMargin);
  return layout;
}

/// Transformation from the plane to the canvas.
struct Plan {
  AxisScale x;
  AxisScale y;

  Point at(const Vec2& p) const { return {x.at(p.x()), y.at(p.y())}; }
  std::vector<Point> at(const Polygon& polygon, const Vec2& moved = Vec2::Zero()) const {
    std::vector<Point> points;
    for (const Vec2& p : polygon) points.push_back(at(Vec2(p + moved)));
    return points;
  }
  Point corner() const { return {x.first, y.last}; }
  Size size() const { return {x.last - x.first, y.first - y.last}; }
};

/// Returns the plan of a panel, centred in its box and to scale.
Plan plan_of(const MapPanel& panel, const MapLayout& layout, Point box_corner) {
  const Rectangle shown = shown_by(panel);
  const double scale = std::min(layout.box.width / shown.size().x(), layout.box.height / shown.size().y());
  const Size size{scale * shown.size().x(), scale * shown.size().y()};
  const double left = box_corner.x + 0.5 * (layout.box.width - size.width);
  const double top = box_corner.y + 0.5 * (layout.box.height - size.height);
  return {{{shown.lower.x(), shown.upper.x()}, left, left + size.width},
          {{shown.lower.y(), shown.upper.y()}, top + size.height, top}};
}

/// Returns the displacements of the copies of a periodic panel. If the panel is not periodic, returns only the zero
/// vector.
std::vector<Vec2> copies_of(const MapPanel& panel) {
  if (!panel.is_periodic) return {Vec2::Zero()};
  const Vec2 period = geometry::bounding_box(panel.outline).size();
  const Vec2 shown = shown_by(panel).size();
  const int beyond_x = static_cast<int>(std::ceil(0.5 * (shown.x() / period.x() - 1.0)));
  const int beyond_y = static_cast<int>(std::ceil(0.5 * (shown.y() / period.y() - 1.0)));
  std::vector<Vec2> copies;
  for (int j = -beyond_y; j <= beyond_y; ++j)
    for (int i = -beyond_x; i <= beyond_x; ++i) copies.emplace_back(i * period.x(), j * period.y());
  return copies;
}

/// Returns true if the bounding box of the displaced points overlaps with the rectangle that the panel shows.
template <class Points>
bool is_shown(const MapPanel& panel, const Points& points, const Vec2& moved) {
  const Rectangle shown = shown_by(panel);
  Vec2 lower = points[0];
  Vec2 upper = points[0];
  for (const Vec2& p : points) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  return ((lower + moved).array() <= shown.upper.array()).all() &&
         ((upper + moved).array() >= shown.lower.array()).all();
}

using Paths = std::vector<std::vector<Point>>;

/// Draws the regions. Regions of the same colour are filled in one operation.
void draw_regions(Canvas& canvas, const MapPanel& panel, const Plan& plan, const Range& values) {
  std::map<int, Paths> by_colour;
  for (const Vec2& copy : copies_of(panel))
    for (const MapRegion& region : panel.regions) {
      if (region.outline.empty() || !is_shown(panel, region.outline, copy)) continue;
      const double share = std::clamp((region.value - values.low) / values.span(), 0.0, 1.0);
      by_colour[static_cast<int>(std::lround(share * kColourSteps))].push_back(plan.at(region.outline, copy));
    }
  for (const auto& [step, paths] : by_colour)
    canvas.fill(paths, colour_at(kMapScale, static_cast<double>(step) / kColourSteps), kSwell);
}

void draw_lines(Canvas& canvas, const MapPanel& panel, const Plan& plan) {
  const std::size_t count = panel.lines.size() + panel.fine_lines.size();
  const double room = std::sqrt(plan.size().width * plan.size().height / static_cast<double>(count));
  if (count == 0 || room < kMinLineDistance) return;
  const double width = std::clamp(0.03 * room, 0.3, 1.0);
  for (const auto& [lines, stroke] : {std::pair{&panel.fine_lines, Stroke{kLine, 0.5 * width, {}}},
                                      std::pair{&panel.lines, Stroke{kLine, width, {}}}})
    for (const Vec2& copy : copies_of(panel))
      for (const MapLine& line : *lines)
        if (is_shown(panel, line, copy)) canvas.line({plan.at(line[0] + copy), plan.at(line[1] + copy)}, stroke);
}

/// Makes the surroundings of the central period pale.
void veil_surroundings(Canvas& canvas, const Plan& plan, const std::vector<Point>& outline) {
  const Point corner = plan.corner();
  const Size size = plan.size();
  const double left = outline[0].x;
  const double right = outline[2].x;
  const double bottom = outline[0].y;
  const double top = outline[2].y;
  const auto rectangle = [](double x0, double y0, double x1, double y1) {
    return std::vector<Point>{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  };
  const double end_x = corner.x + size.width;
  const double end_y = corner.y + size.height;
  canvas.fill({rectangle(corner.x, corner.y, end_x, top), rectangle(corner.x, bottom, end_x, end_y),
               rectangle(corner.x, top, left, bottom), rectangle(right, top, end_x, bottom)},
              kWhite, 0.0, kSurroundingsVeil);
}

void draw_plan(Canvas& canvas, const MapPanel& panel, const Plan& plan, const Range& values) {
  if (panel.outline.empty()) return;
  const std::vector<Point> outline = plan.at(panel.outline);
  const std::vector<Point> frame = panel.is_periodic ? plan.at(geometry::to_polygon(shown_by(panel))) : outline;
  canvas.fill({frame}, kRest);
  canvas.hatch(frame, kHatchSpacing, {kHatch, 0.8, {}});
  canvas.clip(frame);
  draw_regions(canvas, panel, plan, values);
  draw_lines(canvas, panel, plan);
  if (panel.is_periodic) veil_surroundings(canvas, plan, outline);
  canvas.end_clip();
  std::vector<Point> border = outline;
  border.push_back(border.front());
  canvas.line(border, {kAxis, 1.3, panel.is_periodic ? std::vector<double>{6.0, 3.0} : std::vector<double>{}});
}

void draw_axes(Canvas& canvas, const Plan& plan) {
  const Stroke axis{kAxis, 1.0, {}};
  const double left = plan.corner().x - 6.0;
  const double bottom = plan.corner().y + plan.size().height + 6.0;
  canvas.line({{plan.x.first, bottom}, {plan.x.last, bottom}}, axis);
  canvas.line({{left, plan.y.first}, {left, plan.y.last}}, axis);
  const auto most = [](double length, double each) { return std::max(1, static_cast<int>(length / each)); };
  draw_x_ticks(canvas, kMapAxis, plan.x, make_ticks(plan.x.values, most(plan.size().width, 48.0)), bottom);
  draw_y_ticks(canvas, kMapAxis, plan.y, make_ticks(plan.y.values, most(plan.size().height, 34.0)), left);
}

void draw_panel(Canvas& canvas, const MapPanel& panel, const MapLayout& layout, Point cell_corner) {
  const double middle = cell_corner.x + kPlanLeft + 0.5 * layout.box.width;
  const Plan plan = plan_of(panel, layout, {cell_corner.x + kPlanLeft, cell_corner.y + layout.head});
  double baseline = plan.corner().y - 9.0;
  const auto line_above = [&](const std::string& text, Font font, Colour colour) {
    draw_within(canvas, layout.cell.width - 8.0, Ellipsis::middle, {middle, baseline}, text, font, colour,
                Align::centre);
    baseline -= font.size + 5.0;
  };
  for (auto remark = panel.remarks.rbegin(); remark != panel.remarks.rend(); ++remark)
    line_above(*remark, kMapRemarkFont, kFaint);
  line_above(panel.title, kPanelFont, kText);
  draw_plan(canvas, panel, plan, layout.values);
  draw_axes(canvas, plan);
}

void draw_colour_bar(Canvas& canvas, const MapPlot& plot, const MapLayout& layout) {
  const double right = layout.bar_left + kMapBarWidth;
  const double bottom = layout.bar_top + layout.bar_height;
  const double step = layout.bar_height / kColourSteps;
  for (int k = 0; k < kColourSteps; ++k)  // each step is drawn slightly too high, so that there are no gaps
    canvas.fill_rectangle({layout.bar_left, layout.bar_top + k * step},
                          {kMapBarWidth, k + 1 < kColourSteps ? 1.5 * step : step},
                          colour_at(kMapScale, 1.0 - (k + 0.5) / kColourSteps));
  const AxisScale scale{layout.values, bottom, layout.bar_top};
  draw_frame(canvas, {layout.bar_left, layout.bar_top}, {kMapBarWidth, layout.bar_height}, 0.9);
  draw_bar_ticks(canvas, kMapBarAxis, scale, layout.value_ticks, right);
  double widest = 0.0;
  for (const std::string& label : layout.value_ticks.labels)
    widest = std::max(widest, canvas.text_width(label, kMapTickFont));
  canvas.text(
      {right + kMapTickLength + 4.0 + widest + 6.0 + kMapLabelFont.size, layout.bar_top + 0.5 * layout.bar_height},
      plot.value_label, kMapLabelFont, kText, Align::centre, true);

  const double top = bottom + 18.0;
  const std::vector<Point> swatch = {
      {layout.bar_left, top}, {right, top}, {right, top + kMapBarWidth}, {layout.bar_left, top + kMapBarWidth}};
  canvas.fill({swatch}, kRest);
  canvas.hatch(swatch, kHatchSpacing, {kHatch, 0.8, {}});
  draw_frame(canvas, {layout.bar_left, top}, {kMapBarWidth, kMapBarWidth}, 0.9);
  canvas.text({right + 6.0, top + 0.5 * kMapBarWidth + 0.36 * kMapTickFont.size}, plot.hatched_label, kMapTickFont,
              kText, Align::left);
}

}  // namespace

std::string render(const MapPlot& plot, PlotFormat format, double scale) {
  const MapLayout layout = lay_out(plot, measuring_canvas());
  Canvas canvas(format, layout.figure, scale);
  canvas.fill_rectangle({0.0, 0.0}, layout.figure, kWhite);
  draw_title(canvas, layout.figure, plot.title);
  for (std::size_t k = 0; k < plot.panels.size(); ++k) {
    const Point corner{layout.left + layout.cell.width * static_cast<double>(k % layout.columns),
                       layout.top + layout.cell.height * static_cast<double>(k / layout.columns)};
    draw_panel(canvas, plot.panels[k], layout, corner);
  }
  const double grid_width = layout.cell.width * static_cast<double>(layout.columns);
  const double grid_height = layout.cell.height * static_cast<double>(layout.rows);
  canvas.text({layout.left + 0.5 * (grid_width + 22.0), layout.top + grid_height + kMapLabelFont.size - 8.0},
              fmt::format("x ({})", plot.axis_unit), kMapLabelFont, kText, Align::centre);
  canvas.text({kMargin + kMapLabelFont.size - 4.0, layout.top + 0.5 * grid_height},
              fmt::format("y ({})", plot.axis_unit), kMapLabelFont, kText, Align::centre, true);
  draw_colour_bar(canvas, plot, layout);
  return canvas.finish();
}

}  // namespace retrace::report
