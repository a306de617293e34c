#pragma once

// Places dimension lines round a figure so that no text collides with a line or another text.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "report/canvas.h"

namespace retrace::report {

enum class DimensionSide { below, left, above, right };

/// A dimension of something on paper, y down.
struct PaperDimension {
  DimensionSide side = DimensionSide::below;
  Point from;
  Point to;
  std::string text;
  double text_width = 0.0;
};

/// Where a dimension goes: lines from what is measured, the dimension line, its arrows' tips, and the text.
struct PlacedDimension {
  std::array<std::pair<Point, Point>, 2> extensions;
  std::pair<Point, Point> line;
  std::array<Point, 2> tips;
  bool arrows_point_inward = false;  ///< from outside, where there is no room between
  Point text_at;                     ///< middle of its baseline
  bool upwards = false;
  std::string text;
};

/// Places dimensions on the four sides of a figure, in the order given from the inside out, so that no text lies on a
/// line or another text. \param lower, upper corners of the figure, y down
std::vector<PlacedDimension> place_dimensions(const std::vector<PaperDimension>& dimensions, Point lower, Point upper);

}  // namespace retrace::report
