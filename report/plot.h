#pragma once

// Line plots: curves with error bars over one pair of axes, such as RRE over incidence.

#include <optional>
#include <string>
#include <vector>

#include "report/axis_ticks.h"
#include "report/render.h"

namespace retrace::report {

/// One curve. A point whose x or y is not finite is left out and interrupts the line.
struct Series {
  std::string label;  ///< in the legend; empty: no entry there
  std::vector<double> x;
  std::vector<double> y;        ///< as many as x
  std::vector<double> y_error;  ///< standard errors, as many as x, or none

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
  void add(double at, double value, double error) {
    add(at, value);
    y_error.push_back(error);
  }
};

/// What a line plot shows. Texts are UTF-8; what does not fit is wrapped, then shortened by an ellipsis.
struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::optional<Range> x_range;  ///< default: the points' own
  std::optional<Range> y_range;  ///< default: \ref rounded_range of the points
};

/// What render_svg() and render_png() call.
std::string render(const LinePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
