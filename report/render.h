#pragma once

// Turns plots of every kind into SVG or PNG; each kind brings its own render().

#include <string>

namespace retrace::report {

enum class PlotFormat { svg, png };

/// A plot of any kind as an SVG document. The same plot gives the same bytes. \throw OutputError if it cannot be drawn.
template <class Plot>
std::string render_svg(const Plot& plot) {
  return render(plot, PlotFormat::svg, 1.0);
}

/// The plot as a PNG file, `scale` pixels to the drawing unit of the SVG (1/96 inch).
/// \pre 0 < scale <= 16 \throw as render_svg(); std::invalid_argument for a scale out of range.
template <class Plot>
std::string render_png(const Plot& plot, double scale = 2.0) {
  return render(plot, PlotFormat::png, scale);
}

}  // namespace retrace::report
