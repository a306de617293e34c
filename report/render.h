#pragma once

// Converts plots to SVG or PNG. Each kind of plot has an overload of render().

#include <string>

namespace retrace::report {

enum class PlotFormat { svg, png };

/// Returns a plot as an SVG document. Equal plots give equal bytes.
/// \throw OutputError if the plot cannot be drawn
template <class Plot>
std::string render_svg(const Plot& plot) {
  return render(plot, PlotFormat::svg, 1.0);
}

/// Returns a plot as a PNG file. Throws like render_svg().
/// \param scale number of pixels per drawing unit of the SVG (1/96 inch)
/// \pre 0 < scale <= 16
/// \throw std::invalid_argument if the scale is out of range
template <class Plot>
std::string render_png(const Plot& plot, double scale = 2.0) {
  return render(plot, PlotFormat::png, scale);
}

}  // namespace retrace::report
