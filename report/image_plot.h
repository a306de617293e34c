#pragma once

// Plots of pictures: irradiance and luminance maps with scale bars and colour bars, next to each other.

#include <cstddef>
#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A picture of values with a scale bar for lengths or angles and a colour bar for values.
struct ImagePanel {
  std::string title;
  std::string value_label;  ///< name of the values with their unit, such as "relative irradiance"
  std::size_t columns = 1;
  std::size_t rows = 1;
  std::vector<double> values;  ///< row by row from the top, each >= 0
  double width = 1.0;          ///< width of the picture, in `length_unit`
  std::string length_unit;     ///< such as "mm" or "°"; if empty, there is no scale bar
  double full_value = 0.0;     ///< value at the upper end of the colour scale; 0 means the largest value
  /// True: the colour scale is logarithmic and covers the four decades below its upper end.
  bool is_logarithmic = false;
  std::vector<double> circles = {};  ///< radii of circles around the centre of the picture, in `length_unit`
};

/// Panels next to each other under one title, with lines of remarks.
struct ImagePlot {
  std::string title;
  std::vector<std::string> remarks;
  std::vector<ImagePanel> panels;
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const ImagePlot& plot, PlotFormat format, double scale);

/// Returns the length of a scale bar. It is 1, 2 or 5 times a power of ten and about a quarter of `width`.
/// \pre width > 0
double scale_bar_length(double width);

}  // namespace retrace::report
