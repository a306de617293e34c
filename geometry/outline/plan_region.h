#pragma once

// The plan of a part with an outline, as polygons: its border, and the areas of elements and of flat land at the
// border.

#include <optional>
#include <vector>

#include "geometry/outline/outline.h"

namespace retrace::geometry {

/// Convex polygons that do not overlap, and the borders of the region that they fill.
struct ConvexRegion {
  std::vector<Polygon> pieces;
  std::vector<Rectangle> boxes;  ///< bounding boxes of the pieces
  std::vector<PolygonLoop> borders;
};

/// Plan of a part. The curves of its outline are replaced by polygons of equal area. Coordinates are in mm in the part
/// frame, in which the bounding box of the polygon begins at the origin.
struct PlanRegion {
  Outline outline;  ///< exact outline
  double margin_mm = 0.0;
  double tolerance_mm = 0.0;
  Rectangle box_mm;  ///< bounding box of the polygon
  Polygon hull;      ///< convex hull of the polygon, counter-clockwise
  ConvexRegion whole;
  ConvexRegion elements;  ///< area inside the margin; elements are cut at its border
  ConvexRegion margin;    ///< flat land between the outline and the elements; empty without a margin

  double area_mm2() const { return outline.area_mm2(); }
  /// Returns true if the outline is a rectangle whose sides are parallel to the axes. The array then needs no cut.
  bool is_box() const;
  /// Returns true if the part has no holes and a convex outline.
  bool is_convex() const { return whole.pieces.size() == 1; }
};

/// Makes the plan of a part from its outline, and moves it to the origin.
/// \param margin_mm width of the flat land along all borders, >= 0
/// \param tolerance_mm maximum distance between a curve and its polygon
/// \param fault set to a reason if the outline is not allowed or if nothing remains inside the margin; the result is
/// then
///     undefined
PlanRegion plan_region(Outline outline, double margin_mm, double tolerance_mm, std::optional<OutlineFault>& fault);

/// Returns the portions of a convex polygon that are inside a region.
/// \param tolerance_mm as for clip()
std::vector<Polygon> clip(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm);

/// Returns true if no border of a region crosses a convex polygon and the polygon is inside.
bool is_within(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm);

}  // namespace retrace::geometry
