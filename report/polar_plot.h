#pragma once

// Plots of a quantity over directions as coloured discs, such as far fields with the test points of a standard.

#include <cstddef>
#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A place that is marked on a polar panel.
struct PolarMark {
  double right_deg = 0.0;
  double up_deg = 0.0;
  std::string label;
  enum class Kind { holds, open, fails };
  Kind kind = Kind::holds;  ///< a circle, a square, or a warning triangle
};

/// Values around a direction, as colours in a disc whose radius is the angle from it, up being up.
struct PolarPanel {
  std::string title;
  double radius_deg = 1.0;
  std::size_t columns = 0;     ///< and rows, of the square round the disc
  std::vector<double> values;  ///< row by row, the lowest first
  std::vector<PolarMark> marks;
};

/// Discs two or three abreast with one logarithmic colour scale.
struct PolarPlot {
  std::string title;
  std::string value_label;
  std::vector<PolarPanel> panels;
};

/// What render_svg() and render_png() call.
std::string render(const PolarPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
