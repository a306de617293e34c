#pragma once

// Plots of pictures: irradiance and luminance maps with scale bars and colour bars, side by side.

#include <cstddef>
#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A picture of values with a scale bar for lengths or angles and a colour bar for values.
struct ImagePanel {
  std::string title;
  std::string value_label;  ///< with its unit: "relative irradiance"
  std::size_t columns = 1;
  std::size_t rows = 1;
  std::vector<double> values;   ///< row by row from above, each >= 0
  double width = 1.0;           ///< of the picture, in `length_unit`
  std::string length_unit;      ///< "mm", "°"; empty: no scale bar
  double full_value = 0.0;      ///< upper end of the colours; 0: the largest value
  bool is_logarithmic = false;  ///< colours over four decades below the upper end
};

/// Panels side by side under one title, with lines of remarks.
struct ImagePlot {
  std::string title;
  std::vector<std::string> remarks;
  std::vector<ImagePanel> panels;
};

/// What render_svg() and render_png() call.
std::string render(const ImagePlot& plot, PlotFormat format, double scale);

/// The length of a scale bar: 1, 2 or 5 times a power of ten, near a quarter of `width`. \pre width > 0
double scale_bar_length(double width);

}  // namespace retrace::report
