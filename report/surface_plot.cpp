#include "report/surface_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "report/style.h"

namespace retrace::report {
namespace {

constexpr Colour kSurfaceGrid{0.88, 0.88, 0.88};
constexpr Colour kMissingColour{0.75, 0.75, 0.75};
constexpr std::array<Colour, 3> kCurves = {kBlue, kVermilion, kBluishGreen};

constexpr Font kSurfaceLabelFont{12.0, false};
constexpr Font kSurfaceTickFont{10.5, false};
constexpr AxisStyle kSurfaceAxis{.font = kSurfaceTickFont,
                                 .x_label_gap = 6.0 + kSurfaceTickFont.size,
                                 .y_label_gap = 7.0,
                                 .baseline = 0.36 * kSurfaceTickFont.size};

constexpr Size kPlotArea{290.0, 290.0};
constexpr Size kSinglePlotArea{460.0, 460.0};  ///< area of the only panel of a plot
constexpr Size kAroundPlotArea{140.0, 100.0};  ///< space for the texts of a panel
constexpr Font kSurfaceRemarkFont{11.5, false};
constexpr double kSurfaceRemarkLine = 16.0;
/// Length in um from which axes are labelled in mm.
constexpr double kMillimetresFromUm = 2000.0;
constexpr double kSurfaceLeft = 62.0;  ///< distance of the plot area from the left end of its cell
constexpr double kTop = 34.0;
constexpr double kSurfaceBarGap = 12.0;
constexpr double kSurfaceBarWidth = 14.0;
constexpr std::size_t kMaxPixels = 480;  ///< maximum number of pixels of a grid along an axis; finer grids are
                                         ///< averaged
/// Distance from the mean, in standard deviations, at which heights reach the end of the colour scale.
constexpr double kColourReach = 3.0;

/// Returns the range of values that the colour scale covers.
Range colour_range(const std::vector<double>& values) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) {
      sum += v;
      squares += v * v;
      count += 1.0;
    }
  const Range all = extent_of(values).value_or(Range{0.0, 1.0});
  if (count == 0.0) return drawable(all);
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
  return drawable(
      {std::max(all.low, mean - kColourReach * deviation), std::min(all.high, mean + kColourReach * deviation)});
}

/// Returns a grid of at most kMaxPixels along each axis, which contains averages of blocks.
GridPanel reduced(const GridPanel& panel) {
  const std::size_t sx = (panel.columns + kMaxPixels - 1) / kMaxPixels;
  const std::size_t sy = (panel.rows + kMaxPixels - 1) / kMaxPixels;
  GridPanel small = panel;
  small.columns = (panel.columns + sx - 1) / sx;
  small.rows = (panel.rows + sy - 1) / sy;
  small.values.clear();
  for (std::size_t row = 0; row < panel.rows; row += sy)
    for (std::size_t column = 0; column < panel.columns; column += sx) {
      double sum = 0.0;
      double count = 0.0;
      for (std::size_t j = row; j < std::min(panel.rows, row + sy); ++j)
        for (std::size_t i = column; i < std::min(panel.columns, column + sx); ++i) {
          const double v = panel.values[j * panel.columns + i];
          if (!std::isfinite(v)) continue;
          sum += v;
          count += 1.0;
        }
      small.values.push_back(count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN());
    }
  return small;
}

/// Position and size of the area between the axes of a panel.
struct Area {
  Point corner;
  Size size;

  double right() const { return corner.x + size.width; }
  double bottom() const { return corner.y + size.height; }
};

void draw_texts(Canvas& canvas, const Area& area, Point cell, std::string_view title, std::string_view x_label,
                std::string_view y_label) {
  const double middle = area.corner.x + 0.5 * area.size.width;
  canvas.text({cell.x + kSurfaceLeft, cell.y + 22.0}, title, kPanelFont, kText, Align::left);
  canvas.text({middle, area.bottom() + 38.0}, x_label, kSurfaceLabelFont, kText, Align::centre);
  canvas.text({cell.x + 14.0, area.corner.y + 0.5 * area.size.height}, y_label, kSurfaceLabelFont, kText, Align::centre,
              true);
}

void draw_bar(Canvas& canvas, const Area& area, const ColourScale& colours, Range range, int intervals,
              std::string_view label) {
  const double left = area.right() + kSurfaceBarGap;
  draw_colour_bar(canvas, colours, {left, area.corner.y}, {kSurfaceBarWidth, area.size.height});
  draw_frame(canvas, {left, area.corner.y}, {kSurfaceBarWidth, area.size.height});
  const AxisScale scale{range, area.bottom(), area.corner.y};
  const Ticks ticks = make_ticks(range, intervals);
  draw_bar_ticks(canvas, kSurfaceAxis, scale, ticks, left + kSurfaceBarWidth);
  double widest = 0.0;
  for (const std::string& tick : ticks.labels) widest = std::max(widest, canvas.text_width(tick, kSurfaceTickFont));
  canvas.text({left + kSurfaceBarWidth + widest + 22.0, area.corner.y + 0.5 * area.size.height}, label,
              kSurfaceLabelFont, kText, Align::centre, true);
}

void draw_linear_axes(Canvas& canvas, const Area& area, Range x_range, Range y_range, bool y_down) {
  const AxisScale x{x_range, area.corner.x, area.right()};
  const AxisScale y{y_range, y_down ? area.corner.y : area.bottom(), y_down ? area.bottom() : area.corner.y};
  draw_x_ticks(canvas, kSurfaceAxis, x, make_ticks(x_range, 5), area.bottom());
  draw_y_ticks(canvas, kSurfaceAxis, y, make_ticks(y_range, 5), area.corner.x);
}

/// Draws a profile: heights over x.
void draw_profile(Canvas& canvas, const GridPanel& panel, Point cell, Size room) {
  const Area area{{cell.x + kSurfaceLeft, cell.y + kTop}, room};
  const Range heights = drawable(extent_of(panel.values).value_or(Range{0.0, 1.0}));
  const AxisScale x{{0.0, panel.x_size_um}, area.corner.x, area.right()};
  const AxisScale y{heights, area.bottom(), area.corner.y};
  std::vector<Point> stretch;
  const auto draw_stretch = [&] {
    if (stretch.size() > 1) canvas.line(stretch, {kCurves[0], 1.0, {}});
    stretch.clear();
  };
  for (std::size_t i = 0; i < panel.values.size(); ++i) {
    const double at = (static_cast<double>(i) + 0.5) * panel.x_size_um / static_cast<double>(panel.columns);
    if (std::isfinite(panel.values[i]))
      stretch.push_back({x.at(at), y.at(panel.values[i])});
    else
      draw_stretch();
  }
  draw_stretch();
  draw_frame(canvas, area.corner, area.size);
  draw_linear_axes(canvas, area, x.values, heights, false);
  draw_texts(canvas, area, cell, panel.title, "x (µm)", panel.value_label);
}

/// Returns the size of a grid that is drawn to scale within an area. Narrow grids are drawn with a minimum width.
Size grid_size(const GridPanel& panel, Size room) {
  const double scale = std::min(room.width / panel.x_size_um, room.height / panel.y_size_um);
  return {std::max(20.0, scale * panel.x_size_um), std::max(20.0, scale * panel.y_size_um)};
}

void draw(Canvas& canvas, const GridPanel& panel, Point cell, Size room) {
  if (panel.rows == 1) {
    draw_profile(canvas, panel, cell, room);
    return;
  }
  const Area area{{cell.x + kSurfaceLeft, cell.y + kTop}, grid_size(panel, room)};
  const GridPanel small = reduced(panel);
  const bool is_deviation = panel.deviation_limit > 0.0;
  const ColourScale& scale = is_deviation ? kBlueWhiteRed : kViridis;
  const Range range = is_deviation ? Range{-panel.deviation_limit, panel.deviation_limit} : colour_range(small.values);
  draw_values(canvas, area.corner, area.size, small.columns, small.values, [&](double v) {
    return std::isfinite(v) ? colour_at(scale, (v - range.low) / range.span()) : kMissingColour;
  });
  draw_frame(canvas, area.corner, area.size);
  const bool in_mm = std::max(panel.x_size_um, panel.y_size_um) >= kMillimetresFromUm;
  const double per_um = in_mm ? 1e-3 : 1.0;
  const char* const unit = in_mm ? "mm" : "µm";
  const auto [x_um, y_um] = panel.lower_left_um.value_or(std::array{0.0, 0.0});
  draw_linear_axes(canvas, area, {per_um * x_um, per_um * (x_um + panel.x_size_um)},
                   {per_um * y_um, per_um * (y_um + panel.y_size_um)}, !panel.lower_left_um.has_value());
  // The ends of the bar of deviations have labels.
  draw_bar(canvas, area, scale, range, is_deviation ? 4 : 5, panel.value_label);
  draw_texts(canvas, area, cell, panel.title, fmt::format("{} ({})", panel.x_name, unit),
             fmt::format("{} ({})", panel.y_name, unit));
}

/// Returns the range of decades that contains all positive values, limited to `most` decades below the highest.
Range decades(const LogPanel& panel, bool of_x, double most) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const LogCurve& curve : panel.curves)
    for (const double v : of_x ? curve.x : curve.y) {
      if (!(v > 0.0) || !std::isfinite(v)) continue;
      range.low = std::min(range.low, std::log10(v));
      range.high = std::max(range.high, std::log10(v));
    }
  if (!(range.low <= range.high)) return {0.0, 1.0};
  range.low = std::max(range.low, range.high - most);
  if (of_x) return drawable(range);
  return drawable({std::floor(range.low), std::ceil(range.high)});
}

void draw(Canvas& canvas, const LogPanel& panel, Point cell, Size room) {
  constexpr double kMaxDecades = 12.0;
  const Area area{{cell.x + kSurfaceLeft, cell.y + kTop}, {room.width + 60.0, room.height}};
  const AxisScale x{decades(panel, true, kMaxDecades), area.corner.x, area.right()};
  const AxisScale y{decades(panel, false, kMaxDecades), area.bottom(), area.corner.y};
  const Ticks x_ticks = decade_ticks(x.values);
  for (const double e : x_ticks.positions)
    canvas.line({{x.at(e), area.corner.y}, {x.at(e), area.bottom()}}, {kSurfaceGrid, 0.9, {}});
  draw_x_ticks(canvas, kSurfaceAxis, x, x_ticks, area.bottom());
  const Ticks y_ticks = decade_ticks(y.values);
  const std::size_t y_step = y.values.span() > 7.0 ? 2 : 1;
  for (std::size_t k = 0; k < y_ticks.positions.size(); k += y_step) {
    const double at = y.at(y_ticks.positions[k]);
    canvas.line({{area.corner.x, at}, {area.right(), at}}, {kSurfaceGrid, 0.9, {}});
    draw_y_tick(canvas, kSurfaceAxis, {area.corner.x, at}, y_ticks.labels[k]);
  }
  canvas.clip(area.corner, area.size);
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const LogCurve& curve = panel.curves[c];
    std::vector<Point> points;
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (curve.x[i] > 0.0 && curve.y[i] > 0.0)
        points.push_back({x.at(std::log10(curve.x[i])), y.at(std::log10(curve.y[i]))});
    if (points.size() > 1) canvas.line(points, {kCurves[c % kCurves.size()], 1.2, {}});
  }
  canvas.end_clip();
  draw_frame(canvas, area.corner, area.size);
  double right = area.right() - 10.0;
  for (std::size_t c = panel.curves.size(); c-- > 0;) {
    canvas.text({right, area.corner.y + 18.0}, panel.curves[c].label, kSurfaceLabelFont, kText, Align::right);
    right -= canvas.text_width(panel.curves[c].label, kSurfaceLabelFont) + 8.0;
    canvas.line({{right - 18.0, area.corner.y + 14.0}, {right, area.corner.y + 14.0}},
                {kCurves[c % kCurves.size()], 2.0, {}});
    right -= 34.0;
  }
  draw_texts(canvas, area, cell, panel.title, panel.x_label, panel.y_label);
}

/// Returns the height of a panel within an area.
double height_of(const std::variant<GridPanel, LogPanel>& panel, Size room) {
  const auto* const grid = std::get_if<GridPanel>(&panel);
  return grid != nullptr && grid->rows > 1 ? grid_size(*grid, room).height : room.height;
}

}  // namespace

std::string render(const SurfacePlot& plot, PlotFormat format, double scale) {
  const bool is_single = plot.panels.size() == 1;
  const Size room = is_single ? kSinglePlotArea : kPlotArea;
  const Size cell_size{room.width + kAroundPlotArea.width,
                       (is_single ? height_of(plot.panels.front(), room) : room.height) + kAroundPlotArea.height};
  const std::size_t columns = is_single ? 1 : 2;
  const std::size_t rows = (plot.panels.size() + columns - 1) / columns;
  const double width = static_cast<double>(columns) * cell_size.width + 2.0 * kMargin;
  const std::vector<std::string> remarks = wrapped(plot.remarks, kSurfaceRemarkFont, width - 2.0 * kMargin);
  const double head =
      24.0 + added_title_height(plot.title, width) + kSurfaceRemarkLine * static_cast<double>(remarks.size());
  const Size size{width, std::ceil(static_cast<double>(rows) * cell_size.height + 2.0 * kMargin + head)};
  Canvas canvas(format, size, scale);
  canvas.fill_rectangle({0.0, 0.0}, size, kWhite);
  draw_title(canvas, size, plot.title);
  double remark_line = kMargin + kTitleFont.size + added_title_height(plot.title, width) + kSurfaceRemarkLine + 2.0;
  for (const std::string& remark : remarks) {
    canvas.text({0.5 * width, remark_line}, remark, kSurfaceRemarkFont, kFaint, Align::centre);
    remark_line += kSurfaceRemarkLine;
  }
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    const Point cell{kMargin + cell_size.width * static_cast<double>(i % columns),
                     kMargin + head + cell_size.height * static_cast<double>(i / columns)};
    std::visit([&](const auto& panel) { draw(canvas, panel, cell, room); }, plot.panels[i]);
  }
  return canvas.finish();
}

}  // namespace retrace::report
