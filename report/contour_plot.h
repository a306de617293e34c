#pragma once

// Plots of a positive quantity over two variables, as coloured rectangles with contour lines on a logarithmic scale.

#include <string>
#include <vector>

#include "report/polar_plot.h"
#include "report/render.h"

namespace retrace::report {

/// A marked point of a panel.
struct ContourMark {
  double x = 0.0;
  double y = 0.0;
  PolarMark::Kind kind = PolarMark::Kind::holds;
};

/// Values over a rectangular grid, whose lines need not be equidistant.
struct ContourPanel {
  std::string title;
  std::string remark;     ///< line under the title; not drawn if empty
  std::vector<double> x;  ///< at least 2, ascending
  std::vector<double> y;  ///< at least 2, ascending
  /// Values >= 0, or NaN where there is no value: all values of the first y, then of the next one.
  std::vector<double> values;
  std::vector<ContourMark> marks;
};

/// Colour scale of contour panels. Both scales are logarithmic.
enum class ContourScale {
  decades,  ///< up to four decades below the largest value
  ratio     ///< values around 1, which is white; the scale extends by the same factor below and above 1
};

/// Panels, up to four in a row, with one colour scale and equal axes.
struct ContourPlot {
  std::string title;
  std::string remark;  ///< line under the title; not drawn if empty
  std::string x_label;
  std::string y_label;
  std::string value_label;
  ContourScale scale = ContourScale::decades;
  std::vector<ContourPanel> panels;
};

/// Levels of the contour lines of a plot with their labels, as decimal logarithms in ascending order.
struct ContourLevels {
  double low = 0.0;   ///< lower end of the colour scale
  double high = 1.0;  ///< upper end of the colour scale
  std::vector<double> positions;
  std::vector<std::string> labels;
};

/// Returns the colour scale of a plot and its contour lines. They are at 1, 2 and 5 times powers of ten, or at round
/// ratios if all ratios are near 1.
ContourLevels contour_levels(const ContourPlot& plot);

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const ContourPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
