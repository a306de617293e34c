#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/axis_ticks.h"

namespace retrace::report {

/// One curve. A point whose x or y is not finite is left out and interrupts the line.
struct Series {
  std::string label;  ///< in the legend; empty: no entry there
  std::vector<double> x;
  std::vector<double> y;        ///< as many as x
  std::vector<double> y_error;  ///< standard errors, as many as x, or none
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

/// The plot as an SVG document. The same plot gives the same bytes.
/// \throw std::invalid_argument if a series' vectors differ in length; OutputError if it cannot be drawn.
std::string render_svg(const LinePlot& plot);

/// The plot as a PNG file, `scale` pixels to the drawing unit of the SVG. The same plot gives the same bytes.
/// \pre 0 < scale <= 16 \throw as render_svg(); std::invalid_argument for a scale out of range.
std::string render_png(const LinePlot& plot, double scale = 2.0);

}  // namespace retrace::report
