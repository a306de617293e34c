#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "report/style.h"

namespace retrace::report {
namespace {

// Dashes and marker shapes change when the colours repeat.
constexpr std::array<Colour, 7> kPalette = {kBlue, kVermilion, kBluishGreen, kReddishPurple, kOrange, kSkyBlue, kBlack};
const std::array<std::vector<double>, 4> kDashes = {{{}, {7.0, 3.5}, {2.0, 2.5}, {8.0, 3.0, 2.0, 3.0}}};
constexpr std::array kMarkers = {Marker::circle, Marker::square, Marker::triangle, Marker::diamond,
                                 Marker::inverted_triangle};

constexpr Colour kGrid{0.90, 0.90, 0.90};
constexpr Colour kShade{0.93, 0.97, 0.93};
constexpr Colour kMinorGrid{0.955, 0.955, 0.955};

constexpr Font kLabelFont{13.5, false};
constexpr Font kTickFont{12.0, false};
constexpr Font kLegendFont{12.0, false};

constexpr double kTickLength = 5.0;
constexpr AxisStyle kPlotAxis{.font = kTickFont,
                              .tick = kTickLength,
                              .x_label_gap = kTickLength + 5.0 + kTickFont.size,
                              .y_label_gap = kTickLength + 5.0,
                              .baseline = 0.36 * kTickFont.size,
                              .width = 1.1};
constexpr double kLineSpacing = 1.3;
constexpr double kLegendRow = 19.0;
constexpr double kLegendKey = 30.0;  ///< length of the line sample in the legend
constexpr double kLegendGap = 8.0;
constexpr double kLegendTextWidth = 360.0;
constexpr std::size_t kMaxLegendEntries = 60;
constexpr std::size_t kMaxMarkers = 45;  ///< maximum number of points of a series with markers; longer series are
                                         ///< drawn as lines only
constexpr int kMaxXTicks = 9;
constexpr int kMaxYTicks = 7;
/// Maximum number of decades of a logarithmic axis, from the largest value downwards.
constexpr int kMaxAxisDecades = 8;
constexpr double kMinorTickLength = 3.0;
/// Minimum half length of an error bar that is drawn. A shorter error bar would be hidden by the marker or the line.
constexpr double kShortestErrorBar = 1.5;

constexpr double kBarWidth = 14.0;  ///< width of the colour bar
constexpr double kBarGap = 22.0;    ///< distance between the axes and the colour bar
constexpr int kMaxBarTicks = 9;
constexpr AxisStyle kBarAxis{
    .font = kTickFont, .tick = 4.0, .y_label_gap = kTickLength + 3.0, .baseline = 0.36 * kTickFont.size};

/// Viridis without its palest colours, which are hard to see as lines on white.
ColourScale line_colours() {
  constexpr double kDarkest = 0.93;
  ColourScale scale;
  for (std::size_t k = 0; k < scale.size(); ++k)
    scale[k] = colour_at(kViridis, kDarkest * static_cast<double>(k) / static_cast<double>(scale.size() - 1));
  return scale;
}

/// Appearance of a series.
struct SeriesStyle {
  Colour colour;
  std::vector<double> dashes;
  Marker marker = Marker::circle;
};

SeriesStyle look_of(std::size_t index) {
  return {kPalette[index % kPalette.size()], kDashes[index / kPalette.size() % kDashes.size()],
          kMarkers[(index % kPalette.size() + index / kPalette.size()) % kMarkers.size()]};
}

std::optional<Range> drawn_scale(const LinePlot& plot) {
  const std::optional<Range> range = scale_range(plot);
  return range ? std::optional(drawable(*range)) : std::nullopt;
}

/// Returns the appearance of a series of the plot.
SeriesStyle look_of(const LinePlot& plot, std::size_t index, const std::optional<Range>& scale) {
  const Series& series = plot.series[index];
  SeriesStyle look = look_of(series.look.value_or(index));
  if (!scale || !series.scale_value) return look;
  look.dashes = kDashes[series.look.value_or(0) % kDashes.size()];
  look.colour = colour_at(line_colours(), (*series.scale_value - scale->low) / scale->span());
  return look;
}

bool is_drawn(const Series& series, std::size_t i) {
  return std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
}

std::size_t drawn_points(const Series& series) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < series.x.size(); ++i) count += is_drawn(series, i) ? 1U : 0U;
  return count;
}

bool has_markers(const Series& series) {
  return !series.has_line || drawn_points(series) <= kMaxMarkers;
}

/// Returns the ranges of both axes.
std::pair<Range, Range> axis_ranges(const LinePlot& plot) {
  std::vector<double> xs;
  std::vector<double> ys;
  std::vector<double> with_errors;
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!is_drawn(series, i)) continue;
      xs.push_back(series.x[i]);
      ys.push_back(series.y[i]);
      const double error = series.y_error.empty() ? 0.0 : series.y_error[i];
      with_errors.push_back(series.y[i] - error);
      with_errors.push_back(series.y[i] + error);
    }
  }
  const Range x = plot.x_range.value_or(extent_of(xs).value_or(Range{0.0, 1.0}));
  if (plot.y_range) return {drawable(x), drawable(*plot.y_range)};
  if (plot.y_is_logarithmic) return {drawable(x), whole_decades(ys, kMaxAxisDecades).value_or(Range{0.0, 1.0})};
  const Range data = extent_of(ys).value_or(Range{0.0, 1.0});
  Range y = rounded_range(data, extent_of(with_errors).value_or(data), kMaxYTicks);
  // Axes in percent are limited to the range from 0 to 100.
  if (plot.y_label.find('%') != std::string::npos && data.low >= 0.0 && data.high <= 100.0)
    y = drawable({std::max(y.low, 0.0), std::min(y.high, 100.0)});
  return {drawable(x), y};
}

struct LegendEntry {
  std::string text;
  double width = 0.0;
  SeriesStyle look;
  bool is_sample = true;  ///< false: the entry has only text
  bool has_markers = true;
};

enum class LegendPlace { none, row, column };

/// Positions of all elements of the plot.
struct Layout {
  Size figure;
  Point corner;  ///< top left corner of the plot area
  AxisScale x;
  AxisScale y;
  Ticks x_ticks;
  Ticks y_ticks;
  std::vector<double> y_minor_ticks;  ///< ticks without labels of a logarithmic axis
  bool y_is_logarithmic = false;
  std::vector<std::string> title;
  std::vector<std::string> x_label;
  std::vector<std::string> y_label;
  std::vector<LegendEntry> legend;
  std::optional<Range> scale;  ///< range of the colour scale
  Ticks scale_ticks;
  double scale_tick_width = 0.0;
  std::vector<std::string> scale_label;
  LegendPlace legend_place = LegendPlace::none;
  double legend_width = 0.0;
  double title_top = 0.0;
};

double height_of(const std::vector<std::string>& lines, Font font) {
  return static_cast<double>(lines.size()) * font.size * kLineSpacing;
}

std::vector<LegendEntry> legend_entries(const LinePlot& plot, const Canvas& canvas) {
  std::vector<LegendEntry> entries;
  std::size_t left_out = 0;
  const auto add = [&](const std::string& label, const SeriesStyle& look, bool with_markers) {
    if (label.empty()) return;
    if (entries.size() == kMaxLegendEntries) {
      ++left_out;
      return;
    }
    std::vector<std::string> lines = canvas.fitted(label, kLegendFont, kLegendTextWidth, 1, Ellipsis::middle);
    std::string text = lines.empty() ? std::string() : std::move(lines.front());
    const double width = canvas.text_width(text, kLegendFont);
    entries.push_back({std::move(text), width, look, true, with_markers});
  };
  const std::optional<Range> scale = drawn_scale(plot);
  if (plot.legend) {
    for (const LegendKey& key : *plot.legend) {
      const bool with_markers =
          std::ranges::any_of(plot.series, [&](const Series& s) { return s.look == key.look && has_markers(s); });
      SeriesStyle look = look_of(key.look);
      if (scale) {
        look.colour = kFaint;
        look.dashes = kDashes[key.look % kDashes.size()];
      }
      add(key.label, look, with_markers);
    }
  } else {
    for (std::size_t i = 0; i < plot.series.size(); ++i)
      add(plot.series[i].label, look_of(plot, i, scale), has_markers(plot.series[i]));
  }
  if (left_out > 0) {
    std::string text = fmt::format("and {} more", left_out);
    const double width = canvas.text_width(text, kLegendFont);
    entries.push_back({std::move(text), width, {}, false, false});
  }
  return entries;
}

double widest(const std::vector<std::string>& labels, const Canvas& canvas) {
  double width = 0.0;
  for (const std::string& label : labels) width = std::max(width, canvas.text_width(label, kTickFont));
  return width;
}

/// Returns as many ticks as possible without an overlap of their labels.
Ticks x_ticks_that_fit(Range range, const Canvas& canvas) {
  for (int most = kMaxXTicks;; --most) {
    Ticks ticks = make_ticks(range, most);
    const double room = ticks.step / range.span() * kPlotAreaWidth;
    if (most == 1 || widest(ticks.labels, canvas) + 10.0 <= room) return ticks;
  }
}

/// Computes the positions of all elements. Uses `canvas` only to measure texts.
Layout lay_out(const LinePlot& plot, const Canvas& canvas) {
  Layout layout;
  const auto [x_range, y_range] = axis_ranges(plot);
  layout.x_ticks = x_ticks_that_fit(x_range, canvas);
  layout.y_is_logarithmic = plot.y_is_logarithmic;
  if (plot.y_is_logarithmic) {
    LogTicks ticks = make_log_ticks(y_range, kMaxYTicks + 2);
    layout.y_ticks = std::move(ticks.decades);
    layout.y_minor_ticks = std::move(ticks.minor);
  } else {
    layout.y_ticks = make_ticks(y_range, kMaxYTicks);
  }
  layout.title = canvas.fitted(plot.title, kTitleFont, kPlotAreaWidth, kMaxTitleLines, Ellipsis::end);
  layout.x_label = canvas.fitted(plot.x_label, kLabelFont, kPlotAreaWidth, 2, Ellipsis::end);
  layout.y_label = canvas.fitted(plot.y_label, kLabelFont, kPlotAreaHeight, 2, Ellipsis::end);
  layout.legend = legend_entries(plot, canvas);
  layout.scale = drawn_scale(plot);
  if (layout.scale) {
    layout.scale_ticks = make_ticks(*layout.scale, kMaxBarTicks);
    layout.scale_tick_width = widest(layout.scale_ticks.labels, canvas);
    layout.scale_label = canvas.fitted(plot.scale_label, kLabelFont, kPlotAreaHeight, 2, Ellipsis::end);
  }

  double row_width = -2.0 * kLegendGap;
  double column_width = 0.0;
  for (const LegendEntry& entry : layout.legend) {
    const double width = kLegendKey + kLegendGap + entry.width;
    row_width += width + 2.0 * kLegendGap;
    column_width = std::max(column_width, width);
  }
  if (!layout.legend.empty())
    layout.legend_place = row_width <= kPlotAreaWidth ? LegendPlace::row : LegendPlace::column;
  layout.legend_width = layout.legend_place == LegendPlace::row ? row_width : column_width;

  const double y_tick_width = widest(layout.y_ticks.labels, canvas);
  const bool in_column = layout.legend_place == LegendPlace::column;
  layout.title_top = kMargin;
  double top = kMargin + height_of(layout.title, kTitleFont) + (layout.title.empty() ? 0.0 : 8.0);
  if (layout.legend_place == LegendPlace::row) top += kLegendRow + 6.0;
  const double left =
      kMargin + height_of(layout.y_label, kLabelFont) + (layout.y_label.empty() ? 0.0 : 6.0) + y_tick_width + 12.0;
  const double below = kTickLength + 8.0 + kTickFont.size + 8.0 + height_of(layout.x_label, kLabelFont) + kMargin;
  const double bar = layout.scale ? kBarGap + kBarWidth + kTickLength + 3.0 + layout.scale_tick_width + 8.0 +
                                        height_of(layout.scale_label, kLabelFont)
                                  : 0.0;
  // The last label of the x axis may extend beyond the right end of the plot.
  const double right = std::max(kMargin, 0.5 * widest(layout.x_ticks.labels, canvas) + 8.0) + bar;
  const double column_height = in_column ? kLegendRow * static_cast<double>(layout.legend.size()) : 0.0;
  layout.corner = {left, top};
  layout.figure = {std::ceil(left + kPlotAreaWidth + right + (in_column ? layout.legend_width + kMargin : 0.0)),
                   std::ceil(top + std::max(kPlotAreaHeight + below, column_height + kMargin))};
  layout.x = {x_range, left, left + kPlotAreaWidth};
  layout.y = {y_range, top + kPlotAreaHeight, top};
  return layout;
}

void draw_axes(Canvas& canvas, const Layout& layout) {
  const double left = layout.corner.x;
  const double right = left + kPlotAreaWidth;
  const double top = layout.corner.y;
  const double bottom = top + kPlotAreaHeight;
  const auto grid = [&](Point from, Point to, bool is_zero) {
    canvas.line({from, to}, {kGrid, is_zero ? 1.6 : 0.9, {}});
  };
  for (const double value : layout.y_minor_ticks) {
    canvas.line({{left, layout.y.at(value)}, {right, layout.y.at(value)}}, {kMinorGrid, 0.7, {}});
    canvas.line({{left - kMinorTickLength, layout.y.at(value)}, {left, layout.y.at(value)}}, {kAxis, 0.7, {}});
  }
  for (const double value : layout.x_ticks.positions)
    grid({layout.x.at(value), top}, {layout.x.at(value), bottom}, value == 0.0);
  for (const double value : layout.y_ticks.positions)
    grid({left, layout.y.at(value)}, {right, layout.y.at(value)}, !layout.y_is_logarithmic && value == 0.0);

  canvas.line({{left, top}, {left, bottom}, {right, bottom}}, {kAxis, kPlotAxis.width, {}});
  draw_x_ticks(canvas, kPlotAxis, layout.x, layout.x_ticks, bottom);
  draw_y_ticks(canvas, kPlotAxis, layout.y, layout.y_ticks, left);
}

void draw_texts(Canvas& canvas, const Layout& layout) {
  const double middle_x = layout.corner.x + 0.5 * kPlotAreaWidth;
  const double middle_y = layout.corner.y + 0.5 * kPlotAreaHeight;
  const auto lines = [](const std::vector<std::string>& texts, Font font, double first_baseline, auto&& put) {
    double baseline = first_baseline;
    for (const std::string& text : texts) {
      put(text, baseline);
      baseline += font.size * kLineSpacing;
    }
  };
  lines(layout.title, kTitleFont, layout.title_top + kTitleFont.size, [&](const std::string& text, double baseline) {
    canvas.text({middle_x, baseline}, text, kTitleFont, kText, Align::centre);
  });
  const double x_label_top = layout.corner.y + kPlotAreaHeight + kTickLength + 8.0 + kTickFont.size + 8.0;
  lines(layout.x_label, kLabelFont, x_label_top + kLabelFont.size, [&](const std::string& text, double baseline) {
    canvas.text({middle_x, baseline}, text, kLabelFont, kText, Align::centre);
  });
  lines(layout.y_label, kLabelFont, kMargin + kLabelFont.size, [&](const std::string& text, double baseline) {
    canvas.text({baseline, middle_y}, text, kLabelFont, kText, Align::centre, true);
  });
}

void draw_legend(Canvas& canvas, const Layout& layout) {
  if (layout.legend_place == LegendPlace::none) return;
  const bool in_row = layout.legend_place == LegendPlace::row;
  Point at = in_row ? Point{layout.corner.x + 0.5 * (kPlotAreaWidth - layout.legend_width), layout.corner.y - 15.0}
                    : Point{layout.figure.width - kMargin - layout.legend_width, layout.corner.y + 0.5 * kLegendRow};
  for (const LegendEntry& entry : layout.legend) {
    if (entry.is_sample) {
      canvas.line({at, {at.x + kLegendKey, at.y}}, {entry.look.colour, 2.0, entry.look.dashes});
      if (entry.has_markers) canvas.marker({at.x + 0.5 * kLegendKey, at.y}, entry.look.marker, 3.4, entry.look.colour);
    }
    canvas.text({at.x + kLegendKey + kLegendGap, at.y + 0.36 * kLegendFont.size}, entry.text, kLegendFont, kText,
                Align::left);
    if (in_row) {
      at.x += kLegendKey + entry.width + 3.0 * kLegendGap;
    } else {
      at.y += kLegendRow;
    }
  }
}

/// Draws the colour bar to the right of the plot area, with its ticks and its label.
void draw_scale(Canvas& canvas, const Layout& layout) {
  if (!layout.scale) return;
  const Point corner{layout.corner.x + kPlotAreaWidth + kBarGap, layout.corner.y};
  draw_colour_bar(canvas, line_colours(), corner, {kBarWidth, kPlotAreaHeight});
  draw_frame(canvas, corner, {kBarWidth, kPlotAreaHeight});
  const AxisScale at{*layout.scale, corner.y + kPlotAreaHeight, corner.y};
  const double left = corner.x + kBarWidth;
  draw_bar_ticks(canvas, kBarAxis, at, layout.scale_ticks, left);
  double baseline = left + kBarAxis.y_label_gap + layout.scale_tick_width + 8.0 + kLabelFont.size;
  for (const std::string& text : layout.scale_label) {
    canvas.text({baseline, corner.y + 0.5 * kPlotAreaHeight}, text, kLabelFont, kText, Align::centre, true);
    baseline += kLabelFont.size * kLineSpacing;
  }
}

/// Returns the radius of markers. The radius is smaller if points are close together, so that markers do not overlap.
double marker_radius(const Series& series, const Layout& layout) {
  double closest = kPlotAreaWidth;
  for (std::size_t i = 1; series.has_line && i < series.x.size(); ++i) {
    if (!is_drawn(series, i - 1) || !is_drawn(series, i)) continue;
    closest = std::min(closest, std::hypot(layout.x.at(series.x[i]) - layout.x.at(series.x[i - 1]),
                                           layout.y.at(series.y[i]) - layout.y.at(series.y[i - 1])));
  }
  return std::clamp(0.45 * closest, 2.4, 3.8);
}

void draw_series(Canvas& canvas, const Layout& layout, const Series& series, const SeriesStyle& look) {
  const auto place = [&](double x, double y) { return Point{layout.x.at(x), layout.y.at(y)}; };
  // The clip area extends beyond the axes by half of the line width, so that curves on the border are drawn with full
  // width.
  canvas.clip({layout.corner.x - 1.5, layout.corner.y - 1.5}, {kPlotAreaWidth + 3.0, kPlotAreaHeight + 3.0});
  // The lines between markers are thin, because they only guide the eye.
  const double width = has_markers(series) ? 1.1 : 1.8;
  std::vector<Point> stretch;
  const auto draw_stretch = [&] {
    if (series.has_line && stretch.size() > 1) canvas.line(stretch, {look.colour, width, look.dashes});
    stretch.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (is_drawn(series, i)) {
      stretch.push_back(place(series.x[i], series.y[i]));
    } else {
      draw_stretch();
    }
  }
  draw_stretch();

  for (std::size_t i = 0; i < series.y_error.size(); ++i) {
    const double error = series.y_error[i];
    if (!is_drawn(series, i) || !std::isfinite(error)) continue;
    const Point low = place(series.x[i], series.y[i] - error);
    const Point high = place(series.x[i], series.y[i] + error);
    if (std::abs(low.y - high.y) < 2.0 * kShortestErrorBar) continue;
    const Stroke bar{look.colour, 1.1, {}};
    canvas.line({low, high}, bar);
    for (const Point end : {low, high}) canvas.line({{end.x - 3.5, end.y}, {end.x + 3.5, end.y}}, bar);
  }
  canvas.end_clip();

  if (!has_markers(series)) return;
  const double radius = marker_radius(series, layout);
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!is_drawn(series, i)) continue;
    if (!layout.x.values.contains(series.x[i]) || !layout.y.values.contains(series.y[i])) continue;
    canvas.marker(place(series.x[i], series.y[i]), look.marker, radius, look.colour);
  }
}

void draw_shades(Canvas& canvas, const Layout& layout, const std::vector<Range>& ranges) {
  for (const Range& range : ranges) {
    const double left = layout.x.at(std::max(range.low, layout.x.values.low));
    const double right = layout.x.at(std::min(range.high, layout.x.values.high));
    if (right > left) canvas.fill_rectangle({left, layout.corner.y}, {right - left, kPlotAreaHeight}, kShade);
  }
}

/// Replaces y by its decimal logarithm, and standard errors by those of the logarithm to first order.
LinePlot with_logarithms(LinePlot plot) {
  if (plot.y_range) plot.y_range = Range{std::log10(plot.y_range->low), std::log10(plot.y_range->high)};
  for (Series& series : plot.series)
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      const double value = series.y[i];
      if (!series.y_error.empty()) series.y_error[i] *= 1.0 / (std::numbers::ln10 * value);
      series.y[i] = value > 0.0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
    }
  return plot;
}

}  // namespace

std::string render(const LinePlot& given, PlotFormat format, double scale) {
  for (const Series& series : given.series) {
    const bool errors_match = series.y_error.empty() || series.y_error.size() == series.x.size();
    if (series.x.size() != series.y.size() || !errors_match)
      throw std::invalid_argument(fmt::format("series '{}': {} x, {} y and {} y_error values", series.label,
                                              series.x.size(), series.y.size(), series.y_error.size()));
  }
  const LinePlot plot = given.y_is_logarithmic ? with_logarithms(given) : given;
  const Layout layout = lay_out(plot, measuring_canvas());
  Canvas canvas(format, layout.figure, scale);
  canvas.fill_rectangle({0.0, 0.0}, layout.figure, kWhite);
  draw_shades(canvas, layout, plot.shaded_x);
  draw_axes(canvas, layout);
  draw_texts(canvas, layout);
  draw_legend(canvas, layout);
  draw_scale(canvas, layout);
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    draw_series(canvas, layout, plot.series[i], look_of(plot, i, layout.scale));
  return canvas.finish();
}

}  // namespace retrace::report
