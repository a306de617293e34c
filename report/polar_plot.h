#pragma once

#include <cstddef>
#include <string>
#include <vector>

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

/// The plot as an SVG document; discs are embedded as pictures. The same plot gives the same bytes.
/// \throw OutputError if it cannot be drawn
std::string render_svg(const PolarPlot& plot);

/// The plot as a PNG file, `scale` pixels to the drawing unit of the SVG.
/// \pre 0 < scale <= 16 \throw as render_svg(); std::invalid_argument for a scale out of range.
std::string render_png(const PolarPlot& plot, double scale = 2.0);

}  // namespace retrace::report
