#pragma once

// Convex polygons and rectangles in the plane: area, clipping, bounds.

#include <vector>

#include "geometry/vec.h"

namespace retrace::geometry {

/// A convex polygon in the plane, counter-clockwise, in mm.
using Polygon = std::vector<Vec2>;

/// Axis-aligned rectangle. It is empty if an upper bound is not above its lower bound.
struct Rectangle {
  Vec2 lower = Vec2::Zero();
  Vec2 upper = Vec2::Zero();

  Vec2 size() const { return upper - lower; }
  Vec2 centre() const { return 0.5 * (lower + upper); }
  bool empty() const { return !(upper.x() > lower.x() && upper.y() > lower.y()); }
};

double area(const Polygon& polygon);
Vec2 centroid(const Polygon& polygon);
Polygon to_polygon(const Rectangle& rectangle);
Rectangle bounding_box(const Polygon& polygon);
Polygon moved(Polygon polygon, const Vec2& by);
Rectangle moved(const Rectangle& rectangle, const Vec2& by);

/// Returns the intersection of a convex polygon and a rectangle. Vertices within `tolerance_mm` of a border are treated
/// as points on the border and are not moved. An edge that coincides with the border within rounding errors is
/// therefore neither moved nor duplicated. Returns an empty polygon if the intersection is not wider than the
/// tolerance.
Polygon clip(const Polygon& polygon, const Rectangle& rectangle, double tolerance_mm);

/// Returns the intersection of two convex polygons. `tolerance_mm` has the same meaning as in the function above.
Polygon clip(const Polygon& polygon, const Polygon& region, double tolerance_mm);

/// Returns true if a counter-clockwise polygon is convex and winds around once. At each vertex it must turn left,
/// or be straight within the tolerance.
bool is_convex(const Polygon& polygon, double tolerance_mm);

/// Returns the minimum distance between two parallel lines that enclose a convex polygon.
double width(const Polygon& polygon);

/// Returns true if a point is inside a convex polygon or on its border.
bool contains(const Polygon& polygon, const Vec2& point);

/// Returns true if a point is inside a convex polygon or outside of it by at most `tolerance_mm`. If the tolerance is
/// negative, the point must be inside, at a distance of at least |tolerance_mm| from all sides.
bool contains(const Polygon& polygon, const Vec2& point, double tolerance_mm);

/// Returns true if every vertex is in the rectangle, which is enlarged by `tolerance_mm` on all sides.
bool contains(const Rectangle& rectangle, const Polygon& polygon, double tolerance_mm);

}  // namespace retrace::geometry
