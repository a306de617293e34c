#pragma once

// Places dimension lines around a figure so that texts collide neither with lines nor with other texts.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "report/canvas.h"

namespace retrace::report {

enum class DimensionSide { below, left, above, right };

/// A dimension in drawing coordinates, with y down.
struct PaperDimension {
  DimensionSide side = DimensionSide::below;
  Point from;
  Point to;
  std::string text;
  double text_width = 0.0;
};

/// Position of a dimension: its extension lines, the dimension line, the tips of its arrows, and the text.
struct PlacedDimension {
  std::array<std::pair<Point, Point>, 2> extensions;
  std::pair<Point, Point> line;
  std::array<Point, 2> tips;
  bool arrows_point_inward = false;  ///< true if the arrows are outside because there is no room between the lines
  Point text_at;                     ///< centre of the text's baseline
  bool upwards = false;
  std::string text;
};

/// Places dimensions on the four sides of a figure, from the inside out in the given order. Texts overlap neither lines
/// nor other texts.
/// \param lower corner of the figure with the smallest coordinates, y down
/// \param upper corner of the figure with the largest coordinates
std::vector<PlacedDimension> place_dimensions(const std::vector<PaperDimension>& dimensions, Point lower, Point upper);

}  // namespace retrace::report
