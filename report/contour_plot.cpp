#include "report/contour_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/number_format.h"
#include "report/contours.h"
#include "report/style.h"

namespace retrace::report {
namespace {

constexpr Font kContourLabelFont{12.0, false};
constexpr Font kContourTickFont{10.5, false};
constexpr Font kContourRemarkFont{11.0, false};
constexpr AxisStyle kContourAxis{
    .font = kContourTickFont, .tick = 4.0, .x_label_gap = 17.0, .y_label_gap = 7.0, .baseline = 3.6};
constexpr AxisStyle kContourBarAxis{.font = kContourTickFont, .tick = 4.0, .y_label_gap = 7.0, .baseline = 3.6};
constexpr double kContourLeft = 62.0;    ///< space for the labels of the y axis
constexpr double kContourRight = 18.0;   ///< space for half of the last label of the x axis
constexpr double kContourAbove = 44.0;   ///< space for the title and the remark of a panel
constexpr double kContourBelow = 50.0;   ///< space for the labels of the x axis
constexpr double kContourBarGap = 14.0;  ///< distance of the colour bar from the panels
constexpr double kContourBarWidth = 14.0;
constexpr double kContourBarRoom = 108.0;  ///< space for the colour bar with its labels
/// Maximum number of decades that the colour scale covers, downwards from the largest value.
constexpr double kContourDecades = 4.0;
/// Minimum range of the colour scale of ratios: a factor of 1.1 in each direction.
constexpr double kMinRatioDecades = 0.0414;
constexpr double kMaxRatioDecades = 2.0;
/// Number of columns and rows to which the values of a panel are interpolated.
constexpr std::size_t kContourColumns = 241;
constexpr std::size_t kContourRows = 181;

/// Returns the label of a value that is 1, 2 or 5 times a power of ten.
/// \param has_digits true: all digits are written; false: a power of ten is a superscript
std::string level_label(int mantissa, int exponent, bool has_digits) {
  if (has_digits) return fixed(mantissa * std::pow(10.0, exponent), std::max(0, -exponent));
  const std::string power = power_with_superscript(exponent);
  return mantissa == 1 ? power : fmt::format("{}·{}", mantissa, power);
}

/// Adds the levels at 1, 2 and 5 times powers of ten within the range of the scale.
void add_round_levels(ContourLevels& levels) {
  const int first = static_cast<int>(std::floor(levels.low));
  const int last = static_cast<int>(std::ceil(levels.high));
  const bool has_digits = first >= -3 && last <= 5;
  for (int exponent = first; exponent <= last; ++exponent)
    for (const int mantissa : {1, 2, 5}) {
      const double at = exponent + std::log10(static_cast<double>(mantissa));
      if (at < levels.low - 1e-9 || at > levels.high + 1e-9) continue;
      levels.positions.push_back(at);
      levels.labels.push_back(level_label(mantissa, exponent, has_digits));
    }
}

ContourLevels levels_of_decades(double smallest, double largest) {
  const double top = largest > 0.0 ? std::log10(largest) : 0.0;
  const double bottom = smallest > 0.0 ? std::log10(smallest) : top - kContourDecades;
  // A range of at least a third of a decade contains at least one level.
  ContourLevels levels{std::clamp(bottom, top - kContourDecades, top - 0.34), top, {}, {}};
  add_round_levels(levels);
  return levels;
}

ContourLevels levels_of_ratios(double smallest, double largest) {
  double range = kMinRatioDecades;
  for (const double value : {smallest, largest})
    if (value > 0.0) range = std::max(range, std::abs(std::log10(value)));
  range = std::min(range, kMaxRatioDecades);
  ContourLevels levels{-range, range, {}, {}};
  if (range > 0.5) {
    add_round_levels(levels);
    return levels;
  }
  const Ticks ticks = make_ticks({std::pow(10.0, -range), std::pow(10.0, range)}, 10);
  for (std::size_t k = 0; k < ticks.positions.size(); ++k) {
    levels.positions.push_back(std::log10(ticks.positions[k]));
    levels.labels.push_back(ticks.labels[k]);
  }
  return levels;
}

/// Position of a value in an ascending list.
struct ContourPosition {
  std::size_t index = 0;  ///< index of the last value at or before the position
  double fraction = 0.0;  ///< fraction of the distance to the next value
};

ContourPosition position_in(const std::vector<double>& values, double value) {
  const auto after = std::upper_bound(values.begin() + 1, values.end() - 1, value);
  const auto k = static_cast<std::size_t>(after - values.begin()) - 1;
  return {k, (value - values[k]) / (values[k + 1] - values[k])};
}

/// Returns the decimal logarithms of the values of a panel at kContourColumns x kContourRows points, row by row from
/// the bottom. Logarithms are interpolated linearly. They are limited to a range around the colour scale, so that
/// contour lines near zeros are smooth.
std::vector<double> interpolated(const ContourPanel& panel, const ContourLevels& levels) {
  const double low = levels.low - 0.5;
  std::vector<double> logarithms;
  for (const double value : panel.values)
    logarithms.push_back(std::isnan(value) ? value : value > 0.0 ? std::max(low, std::log10(value)) : low);
  std::vector<ContourPosition> columns;
  for (std::size_t k = 0; k < kContourColumns; ++k)
    columns.push_back(position_in(
        panel.x, std::lerp(panel.x.front(), panel.x.back(), static_cast<double>(k) / (kContourColumns - 1))));
  std::vector<double> result;
  result.reserve(kContourColumns * kContourRows);
  for (std::size_t row = 0; row < kContourRows; ++row) {
    const ContourPosition y =
        position_in(panel.y, std::lerp(panel.y.front(), panel.y.back(), static_cast<double>(row) / (kContourRows - 1)));
    const double* const below = logarithms.data() + y.index * panel.x.size();
    const double* const above = below + panel.x.size();
    for (const ContourPosition& x : columns)
      result.push_back(std::lerp(std::lerp(below[x.index], below[x.index + 1], x.fraction),
                                 std::lerp(above[x.index], above[x.index + 1], x.fraction), y.fraction));
  }
  return result;
}

Colour colour_of(const ContourLevels& levels, ContourScale scale, double logarithm) {
  if (!std::isfinite(logarithm)) return {0.85, 0.85, 0.85};
  return colour_at(scale == ContourScale::ratio ? kBlueWhiteRed : kViridis,
                   (logarithm - levels.low) / (levels.high - levels.low));
}

/// Dimensions that are the same for all panels.
struct ContourLayout {
  std::size_t abreast = 1;
  std::size_t rows = 1;
  Size area;  ///< size of the coloured rectangle of a panel
  double head = 0.0;
  Size figure;

  Size cell() const { return {kContourLeft + area.width + kContourRight, kContourAbove + area.height + kContourBelow}; }
};

/// Returns the number of panels in a row. It is at most 4, and is chosen such that the last row is full if possible.
std::size_t panels_abreast(std::size_t count) {
  if (count <= 3) return count;
  if (count == 4) return 2;
  return count % 3 != 0 && count % 4 == 0 ? 4 : 3;
}

ContourLayout layout_of(const ContourPlot& plot) {
  ContourLayout layout;
  const std::size_t count = std::max<std::size_t>(1, plot.panels.size());
  layout.abreast = panels_abreast(count);
  layout.rows = (count + layout.abreast - 1) / layout.abreast;
  layout.area = count == 1 ? Size{480.0, 340.0} : Size{300.0, 220.0};
  layout.figure.width = 2.0 * kMargin + static_cast<double>(layout.abreast) * layout.cell().width + kContourBarRoom;
  layout.head = 24.0 + added_title_height(plot.title, layout.figure.width) + (plot.remark.empty() ? 0.0 : 18.0);
  layout.figure.height =
      std::ceil(2.0 * kMargin + layout.head + static_cast<double>(layout.rows) * layout.cell().height);
  return layout;
}

/// Axes of a panel in the drawing.
struct ContourArea {
  AxisScale x;
  AxisScale y;
  Point corner() const { return {x.first, y.last}; }
};

void draw_contours(Canvas& canvas, const std::vector<double>& values, const ContourArea& area, const ContourPlot& plot,
                   const ContourLevels& levels) {
  const double width = (area.x.last - area.x.first) / (kContourColumns - 1);
  const double height = (area.y.first - area.y.last) / (kContourRows - 1);
  for (const double level : levels.positions) {
    // The line at a ratio of 1 is left out, because noise would determine its shape where the designs are equal.
    if (plot.scale == ContourScale::ratio && std::abs(level) < 1e-9) continue;
    const bool is_decade = std::abs(level - std::round(level)) < 1e-9;
    const Colour colour = contour_colour(colour_of(levels, plot.scale, level));
    for (const std::vector<Point>& line : contour_lines(values, kContourColumns, level)) {
      std::vector<Point> drawn;
      for (const Point& p : line) drawn.push_back({area.x.first + width * p.x, area.y.first - height * p.y});
      canvas.line(drawn, {colour, is_decade ? 1.3 : 0.6, {}});
    }
  }
}

void draw_panel_values(Canvas& canvas, const ContourPanel& panel, const ContourArea& area, const ContourPlot& plot,
                       const ContourLevels& levels) {
  const Size size{area.x.last - area.x.first, area.y.first - area.y.last};
  const std::vector<double> values = interpolated(panel, levels);
  canvas.clip(area.corner(), size);
  draw_values(canvas, area.corner(), size, kContourColumns, with_reversed_rows(values, kContourColumns),
              [&](double value) { return colour_of(levels, plot.scale, value); });
  draw_contours(canvas, values, area, plot, levels);
  canvas.end_clip();
  draw_frame(canvas, area.corner(), size);
}

void draw_panel(Canvas& canvas, const ContourPanel& panel, Point cell, const ContourLayout& layout,
                const ContourPlot& plot, const ContourLevels& levels) {
  const Point corner{cell.x + kContourLeft, cell.y + kContourAbove};
  const double bottom = corner.y + layout.area.height;
  const ContourArea area{{{panel.x.front(), panel.x.back()}, corner.x, corner.x + layout.area.width},
                         {{panel.y.front(), panel.y.back()}, bottom, corner.y}};
  const double middle = corner.x + 0.5 * layout.area.width;
  draw_within(canvas, layout.area.width, Ellipsis::middle, {middle, corner.y - (panel.remark.empty() ? 9.0 : 24.0)},
              panel.title, kPanelFont, kText, Align::centre);
  if (!panel.remark.empty())
    draw_within(canvas, layout.area.width, Ellipsis::end, {middle, corner.y - 8.0}, panel.remark, kContourRemarkFont,
                kFaint, Align::centre);
  draw_panel_values(canvas, panel, area, plot, levels);
  const auto max_intervals = [](double length, double each) { return std::max(2, static_cast<int>(length / each)); };
  draw_x_ticks(canvas, kContourAxis, area.x, make_ticks(area.x.values, max_intervals(layout.area.width, 60.0)), bottom);
  draw_y_ticks(canvas, kContourAxis, area.y, make_ticks(area.y.values, max_intervals(layout.area.height, 40.0)),
               corner.x);
  canvas.text({middle, bottom + 36.0}, plot.x_label, kContourLabelFont, kText, Align::centre);
  canvas.text({cell.x + 18.0, corner.y + 0.5 * layout.area.height}, plot.y_label, kContourLabelFont, kText,
              Align::centre, true);
  for (const ContourMark& mark : panel.marks) draw_mark(canvas, {area.x.at(mark.x), area.y.at(mark.y)}, mark.kind);
}

void draw_level_bar(Canvas& canvas, const ContourPlot& plot, const ContourLevels& levels, Point corner, double height) {
  draw_colour_bar(canvas, plot.scale == ContourScale::ratio ? kBlueWhiteRed : kViridis, corner,
                  {kContourBarWidth, height});
  draw_frame(canvas, corner, {kContourBarWidth, height}, 0.9);
  const AxisScale scale{{levels.low, levels.high}, corner.y + height, corner.y};
  double widest = 0.0;
  for (std::size_t k = 0; k < levels.positions.size(); ++k) {
    draw_bar_tick(canvas, kContourBarAxis, {corner.x + kContourBarWidth, scale.at(levels.positions[k])},
                  levels.labels[k]);
    widest = std::max(widest, canvas.text_width(levels.labels[k], kContourTickFont));
  }
  canvas.text({corner.x + kContourBarWidth + 7.0 + widest + 8.0 + kContourLabelFont.size, corner.y + 0.5 * height},
              plot.value_label, kContourLabelFont, kText, Align::centre, true);
}

}  // namespace

ContourLevels contour_levels(const ContourPlot& plot) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const ContourPanel& panel : plot.panels)
    for (const double value : panel.values) {
      if (!std::isfinite(value)) continue;
      smallest = std::min(smallest, value);
      largest = std::max(largest, value);
    }
  if (!std::isfinite(smallest)) smallest = 0.0;
  return plot.scale == ContourScale::ratio ? levels_of_ratios(smallest, largest) : levels_of_decades(smallest, largest);
}

std::string render(const ContourPlot& plot, PlotFormat format, double scale) {
  const ContourLayout layout = layout_of(plot);
  Canvas canvas(format, layout.figure, scale);
  canvas.fill_rectangle({0.0, 0.0}, layout.figure, kWhite);
  draw_title(canvas, layout.figure, plot.title);
  if (!plot.remark.empty())
    draw_within(canvas, layout.figure.width - 2.0 * kMargin, Ellipsis::end,
                {0.5 * layout.figure.width, kMargin + layout.head - 8.0}, plot.remark, kContourRemarkFont, kFaint,
                Align::centre);
  const ContourLevels levels = contour_levels(plot);
  const Size cell = layout.cell();
  for (std::size_t k = 0; k < plot.panels.size(); ++k)
    draw_panel(canvas, plot.panels[k],
               {kMargin + cell.width * static_cast<double>(k % layout.abreast),
                kMargin + layout.head + cell.height * static_cast<double>(k / layout.abreast)},
               layout, plot, levels);
  draw_level_bar(canvas, plot, levels,
                 {kMargin + cell.width * static_cast<double>(layout.abreast) + kContourBarGap,
                  kMargin + layout.head + kContourAbove},
                 layout.area.height);
  return canvas.finish();
}

}  // namespace retrace::report
