#pragma once

// Convex polygons and rectangles in the plane: area, clipping, bounds.

#include <vector>

#include "geometry/vec.h"

namespace retrace::geometry {

/// A convex polygon in the plane, counter-clockwise, in mm.
using Polygon = std::vector<Vec2>;

/// An axis-aligned rectangle; empty when an upper bound does not exceed its lower bound.
struct Rectangle {
  Vec2 lower = Vec2::Zero();
  Vec2 upper = Vec2::Zero();

  Vec2 size() const { return upper - lower; }
  Vec2 middle() const { return 0.5 * (lower + upper); }
  bool empty() const { return !(upper.x() > lower.x() && upper.y() > lower.y()); }
};

double area(const Polygon& polygon);
Vec2 centroid(const Polygon& polygon);
Polygon to_polygon(const Rectangle& rectangle);
Rectangle bounding_box(const Polygon& polygon);
Polygon moved(Polygon polygon, const Vec2& by);
Rectangle moved(const Rectangle& rectangle, const Vec2& by);

/// The part of a convex polygon inside a rectangle. Vertices within `tolerance_mm` of a border count as on it and stay
/// where they are, so that an edge that coincides with the border up to rounding is neither moved nor doubled. Empty
/// when nothing wider than the tolerance is left.
Polygon clip(const Polygon& polygon, const Rectangle& rectangle, double tolerance_mm);

/// The same of a convex polygon in place of the rectangle.
Polygon clip(const Polygon& polygon, const Polygon& region, double tolerance_mm);

/// Whether a counter-clockwise polygon turns left at every vertex, or runs straight on up to the tolerance, and goes
/// round once.
bool is_convex(const Polygon& polygon, double tolerance_mm);

/// The least distance between two parallel lines that hold a convex polygon between them.
double width(const Polygon& polygon);

/// Whether a place lies in a convex polygon or on its border.
bool contains(const Polygon& polygon, const Vec2& place);

/// True if every vertex lies in the rectangle widened by `tolerance_mm`.
bool contains(const Rectangle& rectangle, const Polygon& polygon, double tolerance_mm);

}  // namespace retrace::geometry
