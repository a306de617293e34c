#pragma once

// Plots tool paths in a section of the part, to scale.

#include <string>
#include <utility>
#include <vector>

#include "geometry/vec.h"
#include "report/render.h"

namespace retrace::report {

/// Straight moves of one kind.
struct PathKind {
  std::string label;
  bool dashed = false;
  std::vector<std::pair<geometry::Vec2, geometry::Vec2>> moves;  ///< start and end of each move
};

/// Tool path in a section, drawn to scale over the material that remains at the end.
struct PathPlot {
  std::string title;
  std::vector<std::string> remarks;  ///< lines under the title
  std::string x_label;
  std::string y_label;
  std::vector<geometry::Vec2> material;  ///< outline of the remaining material
  std::vector<PathKind> kinds;
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const PathPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
