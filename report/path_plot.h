#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace retrace::report {

/// Straight moves of one kind.
struct PathKind {
  std::string label;
  bool dashed = false;
  std::vector<std::pair<geometry::Vec2, geometry::Vec2>> moves;  ///< from, to
};

/// The way of a tool in a section, drawn to scale over the material that is left at the end.
struct PathPlot {
  std::string title;
  std::vector<std::string> remarks;  ///< lines under the title
  std::string x_label;
  std::string y_label;
  std::vector<geometry::Vec2> material;  ///< outline of what is left
  std::vector<PathKind> kinds;
};

/// The plot as an SVG document. The same plot gives the same bytes. \throw OutputError if it cannot be drawn.
std::string render_svg(const PathPlot& plot);

/// The plot as a PNG file, `scale` pixels to the drawing unit of the SVG.
/// \pre 0 < scale <= 16 \throw as render_svg(); std::invalid_argument for a scale out of range.
std::string render_png(const PathPlot& plot, double scale = 2.0);

}  // namespace retrace::report
