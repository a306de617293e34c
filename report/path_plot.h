#pragma once

// Plots of a tool path in a section of the part, to scale.

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

/// What render_svg() and render_png() call.
std::string render(const PathPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
