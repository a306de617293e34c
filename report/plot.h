#pragma once

// Line plots: curves with error bars in one coordinate system, such as RRE over incidence.

#include <optional>
#include <string>
#include <vector>

#include "report/axis_ticks.h"
#include "report/render.h"

namespace retrace::report {

/// A curve. A point whose x or y is not finite is omitted and interrupts the line.
struct Series {
  std::string label;  ///< text in the legend; if empty, the curve is not in the legend
  std::vector<double> x;
  std::vector<double> y;        ///< as many values as `x`
  std::vector<double> y_error;  ///< standard errors of `y`: as many values as `x`, or empty
  bool has_line = true;         ///< false: the points have markers and no line between them

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
  void add(double at, double value, double error) {
    add(at, value);
    y_error.push_back(error);
  }
};

/// Content of a line plot. Texts are UTF-8. Texts that are too long are wrapped and then shortened with an ellipsis.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::optional<Range> x_range;  ///< range of the x axis; by default, the range of the points
  std::optional<Range> y_range;  ///< range of the y axis; by default, rounded_range() of the points
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const LinePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
