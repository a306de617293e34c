#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace retrace::report {

/// Values on a grid, as colours with a bar that explains them; one row is drawn as a curve.
struct GridPanel {
  std::string title;
  std::string value_label;  ///< "height (nm)"
  std::size_t columns = 0;
  std::size_t rows = 0;
  double x_size_um = 0.0;
  double y_size_um = 0.0;
  std::vector<double> values;  ///< row by row, the first on top; grey where not finite
};

/// One curve of positive values.
struct LogCurve {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
};

/// Curves over two logarithmic axes. What is not positive is left out.
struct LogPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<LogCurve> curves;
};

/// Panels two abreast under one title.
struct SurfacePlot {
  std::string title;
  std::vector<std::variant<GridPanel, LogPanel>> panels;
};

/// The plot as an SVG document; grids are embedded as pictures. The same plot gives the same bytes.
/// \throw OutputError if it cannot be drawn
std::string render_svg(const SurfacePlot& plot);

/// The plot as a PNG file, `scale` pixels to the drawing unit of the SVG.
/// \pre 0 < scale <= 16 \throw as render_svg(); std::invalid_argument for a scale out of range.
std::string render_png(const SurfacePlot& plot, double scale = 2.0);

}  // namespace retrace::report
