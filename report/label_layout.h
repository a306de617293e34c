#pragma once

// Places the labels of marked points in a plot so that they do not overlap.

#include <vector>

#include "report/canvas.h"

namespace retrace::report {

/// Rectangle in drawing units, y down.
struct LabelBox {
  Point corner;
  Size size;

  double right() const { return corner.x + size.width; }
  double bottom() const { return corner.y + size.height; }
  bool overlaps(const LabelBox& other) const;
};

/// Marked point and the size of its label.
struct MarkedPoint {
  Point at;
  double radius = 0.0;  ///< radius of the mark, which labels do not cover
  Size label;
};

/// Position of a label.
struct PlacedLabel {
  LabelBox box;
  bool has_leader = false;  ///< true: the label is not next to its mark, so that a line must lead to the label
  Point leader_end;         ///< point of the label that is nearest to the mark
};

/// Places one label per point, in the order of the points. The label is to the right of its mark if there is room.
/// Otherwise positions around the mark are tried at increasing distances. No label overlaps with another label, with a
/// mark or with an obstacle. A label is outside of `bounds` only if there is no free position inside.
/// \param obstacles boxes that are not covered, for example those of other texts
std::vector<PlacedLabel> place_labels(const std::vector<MarkedPoint>& points, const std::vector<LabelBox>& obstacles,
                                      const LabelBox& bounds);

}  // namespace retrace::report
