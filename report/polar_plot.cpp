#include "report/polar_plot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/contours.h"
#include "report/label_layout.h"
#include "report/style.h"

namespace retrace::report {
namespace {

constexpr Colour kRing{0.85, 0.85, 0.85};
constexpr Colour kHolds{1.0, 1.0, 1.0};
constexpr Font kPolarLabelFont{12.0, false};
constexpr Font kPolarTickFont{10.0, false};
constexpr double kDisc = 250.0;  ///< diameter of a disc
constexpr Size kPolarCell{290.0, 304.0};
constexpr double kBarRoom = 96.0;
constexpr double kPolarBarWidth = 14.0;
constexpr std::size_t kMaxPerRow = 3;
constexpr double kMarkLabelHeight = 13.5, kMarkLabelPadding = 3.0;
/// Opacity of the dark area behind the label of a mark, which makes white letters legible on every colour.
constexpr double kMarkLabelShade = 0.55;
/// Number of decades that the colour scale covers, downwards from the largest value.
constexpr double kPolarDecades = 4.0;

std::vector<Point> circle(Point centre, double radius) {
  constexpr int kCorners = 120;
  std::vector<Point> points;
  for (int k = 0; k <= kCorners; ++k) {
    const double a = 2.0 * std::numbers::pi * k / kCorners;
    points.push_back({centre.x + radius * std::cos(a), centre.y - radius * std::sin(a)});
  }
  return points;
}

/// Colours of values, and the ticks of the colour bar.
struct PolarColours {
  Range range;  ///< decimal logarithms of the values if the scale is logarithmic
  bool is_logarithmic = false;
  const ColourScale* scale = &kViridis;
  Ticks ticks;  ///< contour lines are drawn at these values if the scale is linear

  double position(double value) const { return (value - range.low) / range.span(); }
  Colour colour(double value) const {
    if (!std::isfinite(value)) return kWhite;
    if (!is_logarithmic) return colour_at(*scale, position(value));
    return colour_at(*scale, value > 0.0 ? position(std::log10(value)) : 0.0);
  }
};

/// Returns a logarithmic scale that ends at the largest value and covers kPolarDecades.
PolarColours decades_up_to(double largest) {
  const double top = largest > 0.0 ? std::log10(largest) : 0.0;
  const Range range{top - kPolarDecades, top};
  return {range, true, &kViridis, decade_ticks(range)};
}

PolarColours colours_of(const PolarPlot& plot) {
  double largest = 0.0;
  for (const PolarPanel& panel : plot.panels)
    for (const double v : panel.values)
      if (std::isfinite(v)) largest = std::max(largest, plot.scale == PolarScale::difference ? std::abs(v) : v);
  if (plot.scale == PolarScale::decades) return decades_up_to(largest);
  if (!(largest > 0.0)) largest = 1.0;
  if (plot.scale == PolarScale::difference)
    return {{-largest, largest}, false, &kBlueWhiteRed, make_ticks({-largest, largest}, 8)};
  return {{0.0, largest}, false, &kViridis, make_ticks({0.0, largest}, 8)};
}

/// Position of a point of a panel's grid in the drawing.
Point on_disc(const PolarPanel& panel, Point centre, Point on_grid) {
  const double pixel = kDisc / static_cast<double>(panel.columns);
  return {centre.x - 0.5 * kDisc + (on_grid.x + 0.5) * pixel, centre.y + 0.5 * kDisc - (on_grid.y + 0.5) * pixel};
}

/// Draws contour lines at the ticks of the colour scale, dark on light colours and white on dark colours. Differences
/// have no line at 0, because noise would determine its shape.
void draw_contours(Canvas& canvas, const PolarPanel& panel, Point centre, const PolarColours& colours) {
  for (const double level : colours.ticks.positions) {
    if (colours.range.low < 0.0 && level == 0.0) continue;
    const Colour colour = contour_colour(colours.colour(level));
    for (const std::vector<Point>& line : contour_lines(panel.values, panel.columns, level)) {
      std::vector<Point> drawn;
      for (const Point& p : line) drawn.push_back(on_disc(panel, centre, p));
      canvas.line(drawn, {colour, 0.7, {}});
    }
  }
}

void draw_disc(Canvas& canvas, const PolarPanel& panel, Point centre, const PolarColours& colours) {
  const double radius = 0.5 * kDisc;
  if (panel.columns == 0) return;
  canvas.clip(circle(centre, radius));
  draw_values(canvas, {centre.x - radius, centre.y - radius}, {kDisc, kDisc}, panel.columns,
              with_reversed_rows(panel.values, panel.columns), [&](double value) { return colours.colour(value); });
  if (!colours.is_logarithmic) draw_contours(canvas, panel, centre, colours);
  canvas.end_clip();
}

/// Writes the azimuths around a disc.
void draw_azimuths(Canvas& canvas, Point centre) {
  constexpr double kAway = 0.5 * kDisc + 6.0;
  canvas.text({centre.x + kAway, centre.y + 3.6}, "0°", kPolarTickFont, kFaint, Align::left);
  canvas.text({centre.x, centre.y - kAway}, "90°", kPolarTickFont, kFaint, Align::centre);
  canvas.text({centre.x - kAway, centre.y + 3.6}, "180°", kPolarTickFont, kFaint, Align::right);
  canvas.text({centre.x, centre.y + kAway + 8.0}, "270°", kPolarTickFont, kFaint, Align::centre);
}

/// Ring of directions at the same distance from the centre of a disc.
struct Ring {
  double radius = 0.0;
  Point label_end;  ///< right end of the baseline of the label, relative to the centre of the disc
  std::string label;
};

std::vector<Ring> rings_of(const PolarPanel& panel) {
  const double scale = 0.5 * kDisc / panel.radius_deg;
  const Ticks ticks = make_ticks({0.0, panel.radius_deg}, 4);
  std::vector<Ring> rings;
  for (std::size_t k = 0; k < ticks.positions.size(); ++k) {
    if (!(ticks.positions[k] > 0.0)) continue;
    const double diagonal = 0.7071 * scale * ticks.positions[k];
    rings.push_back({scale * ticks.positions[k], {diagonal - 2.0, diagonal}, ticks.labels[k] + "°"});
  }
  return rings;
}

void draw_rings(Canvas& canvas, const PolarPanel& panel, Point centre) {
  for (const Ring& ring : rings_of(panel)) {
    canvas.line(circle(centre, ring.radius), {kRing, 0.7, {3.0, 3.0}});
    canvas.text({centre.x + ring.label_end.x, centre.y + ring.label_end.y}, ring.label, kPolarTickFont, kRing,
                Align::right);
  }
  canvas.line({{centre.x - 5.0, centre.y}, {centre.x + 5.0, centre.y}}, {kRing, 0.8, {}});
  canvas.line({{centre.x, centre.y - 5.0}, {centre.x, centre.y + 5.0}}, {kRing, 0.8, {}});
  canvas.line(circle(centre, 0.5 * kDisc), {kText, 1.0, {}});
}

struct PolarMarkStyle {
  Marker shape = Marker::circle;
  double outline = 4.6;
  double size = 3.4;
  Colour colour = kHolds;
};

PolarMarkStyle style_of(PolarMark::Kind kind) {
  switch (kind) {
    case PolarMark::Kind::holds: return {};
    case PolarMark::Kind::open: return {Marker::square, 5.2, 3.8, kSkyBlue};
    case PolarMark::Kind::fails: return {Marker::triangle, 6.2, 4.6, kOrange};
  }
  return {};
}

}  // namespace

void draw_mark(Canvas& canvas, Point at, PolarMark::Kind kind) {
  const PolarMarkStyle style = style_of(kind);
  canvas.marker(at, style.shape, style.outline, kBlack);
  canvas.marker(at, style.shape, style.size, style.colour);
}

namespace {

/// Returns the boxes of the labels at the rings, relative to the centre of the disc.
std::vector<LabelBox> ring_label_boxes(const Canvas& canvas, const PolarPanel& panel) {
  std::vector<LabelBox> boxes;
  for (const Ring& ring : rings_of(panel)) {
    const double width = canvas.text_width(ring.label, kPolarTickFont);
    boxes.push_back({{ring.label_end.x - width, ring.label_end.y - 8.0}, {width, 10.0}});
  }
  return boxes;
}

/// Returns the position of a mark, relative to the centre of the disc.
Point position_of(const PolarPanel& panel, const PolarMark& mark) {
  const double scale = 0.5 * kDisc / panel.radius_deg;
  return {scale * mark.right_deg, -scale * mark.up_deg};
}

/// Returns the labels of the marks, relative to the centre of the disc.
std::vector<PlacedLabel> labels_of(const Canvas& canvas, const PolarPanel& panel) {
  std::vector<MarkedPoint> points;
  for (const PolarMark& mark : panel.marks)
    points.push_back({position_of(panel, mark),
                      style_of(mark.kind).outline,
                      {canvas.text_width(mark.label, kPolarTickFont) + 2.0 * kMarkLabelPadding, kMarkLabelHeight}});
  const double half_width = 0.5 * kPolarCell.width - 2.0;
  return place_labels(points, ring_label_boxes(canvas, panel),
                      {{-half_width, -0.5 * kDisc}, {2.0 * half_width, kDisc}});
}

void draw_marks(Canvas& canvas, const PolarPanel& panel, Point centre) {
  const std::vector<PlacedLabel> labels = labels_of(canvas, panel);
  const auto moved = [&](Point p) { return Point{centre.x + p.x, centre.y + p.y}; };
  for (std::size_t k = 0; k < labels.size(); ++k)
    if (labels[k].has_leader)
      for (const auto& [colour, width] : {std::pair{kBlack, 2.2}, std::pair{kWhite, 0.9}})
        canvas.line({moved(position_of(panel, panel.marks[k])), moved(labels[k].leader_end)}, {colour, width, {}});
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const PolarMark& mark = panel.marks[k];
    const Point at = moved(position_of(panel, mark));
    draw_mark(canvas, at, mark.kind);
    const LabelBox& box = labels[k].box;
    const Point corner = moved(box.corner);
    const Point end{corner.x + box.size.width, corner.y + box.size.height};
    canvas.fill({{corner, {end.x, corner.y}, end, {corner.x, end.y}}}, kBlack, 0.0, kMarkLabelShade);
    canvas.text({corner.x + kMarkLabelPadding, end.y - 3.6}, mark.label, kPolarTickFont, kWhite, Align::left);
  }
}

void draw_bar(Canvas& canvas, Point corner, const PolarColours& colours, std::string_view label) {
  draw_colour_bar(canvas, *colours.scale, corner, {kPolarBarWidth, kDisc});
  const AxisScale scale{colours.range, corner.y + kDisc, corner.y};
  for (std::size_t k = 0; k < colours.ticks.positions.size(); ++k) {
    const double y = scale.at(colours.ticks.positions[k]);
    canvas.line({{corner.x + kPolarBarWidth, y}, {corner.x + kPolarBarWidth + 4.0, y}}, {kText, 1.0, {}});
    canvas.text({corner.x + kPolarBarWidth + 7.0, y + 3.6}, colours.ticks.labels[k], kPolarTickFont, kText,
                Align::left);
  }
  canvas.text({corner.x + kBarRoom - 24.0, corner.y + 0.5 * kDisc}, label, kPolarLabelFont, kText, Align::centre, true);
}

/// Distances in the cell of a panel.
struct PolarLayout {
  Size cell = kPolarCell;
  double above_disc = 34.0;  ///< distance from the top of the cell to the disc
};

PolarLayout layout_of(const PolarPlot& plot) {
  if (!plot.has_azimuths) return {};
  return {{kPolarCell.width + 36.0, kPolarCell.height + 52.0}, 66.0};
}

}  // namespace

std::vector<LabelBox> mark_label_boxes(const PolarPanel& panel) {
  std::vector<LabelBox> boxes;
  for (const PlacedLabel& label : labels_of(measuring_canvas(), panel)) boxes.push_back(label.box);
  return boxes;
}

std::string render(const PolarPlot& plot, PlotFormat format, double scale) {
  const std::size_t abreast = std::clamp<std::size_t>(plot.panels.size(), 1, kMaxPerRow);
  const std::size_t rows = std::max<std::size_t>(1, (plot.panels.size() + abreast - 1) / abreast);
  const PolarLayout layout = layout_of(plot);
  const double width = 2.0 * kMargin + static_cast<double>(abreast) * layout.cell.width + kBarRoom;
  const double head = 24.0 + added_title_height(plot.title, width);
  const Size size{width, 2.0 * kMargin + head + static_cast<double>(rows) * layout.cell.height};
  Canvas canvas(format, size, scale);
  canvas.fill_rectangle({0.0, 0.0}, size, kWhite);
  draw_title(canvas, size, plot.title);
  const PolarColours colours = colours_of(plot);
  for (std::size_t k = 0; k < plot.panels.size(); ++k) {
    const PolarPanel& panel = plot.panels[k];
    const Point cell{kMargin + layout.cell.width * static_cast<double>(k % abreast),
                     kMargin + head + layout.cell.height * static_cast<double>(k / abreast)};
    const Point centre{cell.x + 0.5 * layout.cell.width, cell.y + layout.above_disc + 0.5 * kDisc};
    draw_within(canvas, layout.cell.width - 8.0, Ellipsis::middle, {centre.x, cell.y + 24.0}, panel.title, kPanelFont,
                kText, Align::centre);
    if (!panel.remark.empty())
      draw_within(canvas, layout.cell.width - 8.0, Ellipsis::end, {centre.x, cell.y + 40.0}, panel.remark,
                  kPolarTickFont, kFaint, Align::centre);
    draw_disc(canvas, panel, centre, colours);
    draw_rings(canvas, panel, centre);
    if (plot.has_azimuths) draw_azimuths(canvas, centre);
    draw_marks(canvas, panel, centre);
  }
  draw_bar(canvas,
           {kMargin + static_cast<double>(abreast) * layout.cell.width + 10.0, kMargin + head + layout.above_disc},
           colours, plot.value_label);
  return canvas.finish();
}

}  // namespace retrace::report
