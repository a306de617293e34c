#pragma once

// Plots of a part in plan, to scale, with regions coloured by a value, such as the active regions of its entrance face.

#include <array>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "report/render.h"

namespace retrace::report {

/// A region with a single value.
struct MapRegion {
  geometry::Polygon outline;
  double value = 0.0;
};

using MapLine = std::array<geometry::Vec2, 2>;

/// A panel with a plan that is drawn to scale.
struct MapPanel {
  std::string title;
  std::vector<std::string> remarks;  ///< lines under the title
  geometry::Polygon outline;
  bool is_periodic = false;         ///< true if the rectangular outline repeats periodically; its surroundings are
                                    ///< drawn paler
  std::vector<MapLine> lines;       ///< lines that are not drawn if they are too close together
  std::vector<MapLine> fine_lines;  ///< finer lines; like `lines`, not drawn if too close together
  std::vector<MapRegion> regions;   ///< coloured regions; the remaining area of the outline is hatched
};

/// Plans next to each other, with one colour scale. Texts are UTF-8; texts that are too long are shortened with an
/// ellipsis.
struct MapPlot {
  std::string title;
  std::string axis_unit;      ///< unit of the axes; "mm" gives the labels "x (mm)" and "y (mm)"
  std::string value_label;    ///< label of the colour bar, which starts at 0
  std::string hatched_label;  ///< meaning of hatched areas
  /// Upper end of the colour bar. If no value of the map exceeds half of this number, a smaller number is used.
  double full_value = 1.0;
  std::vector<MapPanel> panels;
};

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const MapPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report
