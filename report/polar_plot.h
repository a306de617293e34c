#pragma once

// Plots of a quantity over directions as coloured discs, such as far fields with the test points of a standard.

#include <cstddef>
#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A marked direction in a polar panel.
struct PolarMark {
  double right_deg = 0.0;
  double up_deg = 0.0;
  std::string label;
  enum class Kind { holds, open, fails };
  Kind kind = Kind::holds;  ///< kind of mark: a circle, a square, or a warning triangle
};

/// Values for directions around a central direction, as colours in a disc. The distance from the centre of the disc is
/// the angle from the central direction.
struct PolarPanel {
  std::string title;
  double radius_deg = 1.0;
  std::size_t columns = 0;     ///< number of columns and of rows of the square around the disc
  std::vector<double> values;  ///< row by row from the bottom
  std::vector<PolarMark> marks;
};

/// Discs, two or three in a row, with one logarithmic colour scale.
struct PolarPlot {
  std::string title;
  std::string value_label;
  std::vector<PolarPanel> panels;
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const PolarPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
