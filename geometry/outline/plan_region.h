#pragma once

// Plan of a part with an outline, as polygons: the borders of the part, the area of elements and the flat margin.

#include <array>
#include <optional>
#include <vector>

#include "geometry/outline/outline.h"

namespace retrace::geometry {

/// Region of the plane, divided into convex polygons that do not overlap.
struct ConvexRegion {
  std::vector<Polygon> pieces;
  std::vector<Rectangle> boxes;      ///< bounding boxes of the pieces
  std::vector<PolygonLoop> borders;  ///< borders of the region
};

/// Plan of a part. Each loop of the outline is replaced by a polygon of equal area. Coordinates are in mm in the part
/// frame, whose origin is the lower left corner of the bounding box of the outer polygon.
struct PlanRegion {
  Outline outline;  ///< exact outline
  double margin_mm = 0.0;
  double tolerance_mm = 0.0;
  Rectangle box_mm;  ///< bounding box of the outer polygon
  Polygon hull;      ///< convex hull of the outer polygon, counter-clockwise
  ConvexRegion whole;
  ConvexRegion elements;  ///< area enclosed by the margin; elements are cut off at its borders
  ConvexRegion margin;    ///< flat land between the outline and the elements; empty without a margin

  double area_mm2() const { return outline.area_mm2(); }
  /// Returns true if the outline is a rectangle whose sides are parallel to the axes. The array then needs no cut.
  bool is_box() const;
  /// Returns true if the part has no holes and a convex outline.
  bool is_convex() const { return whole.pieces.size() == 1; }
};

/// Returns the plan of a part with an outline. The outline is moved such that the lower left corner of its bounding box
/// is the origin of the part frame.
/// \param margin_mm width of the flat land along all borders, >= 0
/// \param tolerance_mm maximum distance between a curve and its polygon
/// \param fault set if the outline is not allowed or if the margin leaves no connected area for elements. The returned
///     plan must then not be used.
PlanRegion plan_region(Outline outline, double margin_mm, double tolerance_mm, std::optional<OutlineFault>& fault);

/// Returns a plan with a margin of width 0, in which elements extend to the outline.
PlanRegion without_margin(PlanRegion plan);

/// Returns a plan moved by a vector. Its bounding box then no longer begins at the origin.
PlanRegion moved(PlanRegion plan, const Vec2& by);

/// Returns the portions of a convex polygon that are inside a region.
/// \param tolerance_mm as for clip()
std::vector<Polygon> clip(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm);

/// Returns the ends of the portion of a segment that is inside a convex polygon, or nothing if the segment is outside.
std::optional<std::array<Vec2, 2>> clip_segment(const Vec2& from, const Vec2& to, const Polygon& polygon);

/// Returns the coordinate that divides the area of a plan within a rectangle in a given ratio.
/// \param room rectangle; only the area of the plan inside it counts
/// \param axis 0 to divide along x, 1 to divide along y
/// \param fraction fraction of this area for which the coordinate is smaller than the returned one; 0 to 1
/// \pre the plan has an area within `room`
double coordinate_of_area_fraction(const PlanRegion& plan, const Rectangle& room, Eigen::Index axis, double fraction);

/// Returns true if a convex polygon is completely inside a region.
/// \param tolerance_mm maximum area outside the region, divided by the perimeter of the polygon
bool is_within(const Polygon& polygon, const ConvexRegion& region, double tolerance_mm);

}  // namespace retrace::geometry
