#pragma once

// Plots of a part in plan, to scale, with regions coloured by a value, such as the active regions of its entrance face.

#include <array>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "report/render.h"

namespace retrace::report {

/// A region with one value all over it.
struct MapRegion {
  geometry::Polygon outline;
  double value = 0.0;
};

using MapLine = std::array<geometry::Vec2, 2>;

/// A plan, drawn to scale.
struct MapPanel {
  std::string title;
  std::vector<std::string> remarks;  ///< lines under the title
  geometry::Polygon outline;
  bool is_periodic = false;         ///< the outline repeats as a rectangle: its surroundings are drawn paler
  std::vector<MapLine> lines;       ///< left out where they would lie too close
  std::vector<MapLine> fine_lines;  ///< likewise
  std::vector<MapRegion> regions;   ///< what they leave free of the outline is hatched
};

/// Plans side by side, with one colour scale. Texts are UTF-8; what does not fit is shortened by an ellipsis.
struct MapPlot {
  std::string title;
  std::string axis_unit;    ///< "mm": the axes are "x (mm)" and "y (mm)"
  std::string value_label;  ///< of the colour bar, which starts at 0
  std::string rest_label;   ///< what a hatched place is
  double full_value = 1.0;  ///< the upper end of the colour bar if a value exceeds its half
  std::vector<MapPanel> panels;
};

/// What render_svg() and render_png() call.
std::string render(const MapPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
