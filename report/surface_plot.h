#pragma once

// Plots of measured surfaces: height maps with colour bars, and spectra over logarithmic axes.

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "report/render.h"

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

/// What render_svg() and render_png() call.
std::string render(const SurfacePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
