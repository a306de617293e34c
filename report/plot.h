#pragma once

// Line plots: curves with error bars in one coordinate system, such as RRE over incidence.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/axis_ticks.h"
#include "report/render.h"

namespace retrace::report {

/// Size of the area inside of the axes, in drawing units.
inline constexpr double kPlotAreaWidth = 620.0, kPlotAreaHeight = 370.0;

/// A curve. A point whose x or y is not finite is omitted and interrupts the line.
struct Series {
  std::string label;  ///< text in the legend; if empty, the curve is not in the legend
  std::vector<double> x;
  std::vector<double> y;        ///< as many values as `x`
  std::vector<double> y_error;  ///< standard errors of `y`: as many values as `x`, or empty
  bool has_line = true;         ///< false: the points have markers and no line between them
  /// Number of the colour, dashes and markers. By default, the position of the curve in the plot.
  std::optional<std::size_t> look = {};
  std::optional<double> scale_value = {};  ///< value that determines the colour, see LinePlot::scale_label

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
  void add(double at, double value, double error) {
    add(at, value);
    y_error.push_back(error);
  }
};

/// Entry of a legend that stands for several curves.
struct LegendKey {
  std::string label;
  std::size_t look = 0;  ///< Series::look of these curves
};

/// Content of a line plot. Texts are UTF-8. Texts that are too long are wrapped and then shortened with an ellipsis.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  /// Label of the colour scale. If it is not empty, the colours of curves follow from their Series::scale_value, a
  /// colour bar is drawn, and the legend consists of `legend`.
  std::string scale_label = {};
  /// Entries of the legend. By default, the labels of the curves.
  std::optional<std::vector<LegendKey>> legend = {};
  std::optional<Range> x_range = {};  ///< range of the x axis; by default, the range of the points
  /// Range of the y axis. The default is rounded_range() of the points, or whole decades if the axis is logarithmic.
  std::optional<Range> y_range = {};
  std::vector<Range> shaded_x = {};  ///< ranges of x with a shaded background
  bool y_is_logarithmic = false;     ///< true: the y axis is logarithmic; points with y <= 0 are omitted
};

/// Returns the range of the values of the colour scale. Empty if the plot has no colour scale.
inline std::optional<Range> scale_range(const LinePlot& plot) {
  std::optional<Range> range;
  for (const Series& series : plot.series) {
    if (plot.scale_label.empty() || !series.scale_value) continue;
    const double value = *series.scale_value;
    range = range ? Range{std::min(range->low, value), std::max(range->high, value)} : Range{value, value};
  }
  return range;
}

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const LinePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
