#pragma once

// Plots of measured surfaces: height maps with colour bars, and spectra on logarithmic axes.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// Values on a grid, drawn as colours with a colour bar. A grid with one row is drawn as a curve.
struct GridPanel {
  std::string title;
  std::string value_label;  ///< name of the values with their unit, such as "height (nm)"
  std::size_t columns = 0, rows = 0;
  double x_size_um = 0.0, y_size_um = 0.0;
  std::vector<double> values;  ///< row by row from the top; values that are not finite are drawn grey
  /// If not 0, the values are deviations, and the colours cover -limit to limit: blue below 0, white at 0, red above 0.
  double deviation_limit = 0.0;
  /// Coordinates of the lower left corner, for axes with y upwards. If empty, the axes begin at 0 in the upper left
  /// corner.
  std::optional<std::array<double, 2>> lower_left_um = {};
  std::string x_name = "x";
  std::string y_name = "y";
};

/// A curve of positive values.
struct LogCurve {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
};

/// Curves in a diagram with two logarithmic axes. Values that are not positive are omitted.
struct LogPanel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<LogCurve> curves;
};

/// Panels under one title, arranged in rows of two. A single panel is larger.
struct SurfacePlot {
  std::string title;
  std::vector<std::variant<GridPanel, LogPanel>> panels;
  std::vector<std::string> remarks = {};  ///< lines under the title, which are wrapped
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const SurfacePlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
