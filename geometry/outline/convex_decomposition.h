#pragma once

// Divides regions of the plane into convex polygons. The regions may be concave and may have holes.

#include <vector>

#include "geometry/polygon.h"

namespace retrace::geometry {

/// Divides the region inside the first loop and outside the other loops into convex polygons. The corners of the
/// polygons are corners of the loops. Ear clipping gives triangles, which are then joined (Hertel and Mehlhorn 1983).
/// \param loops the outer border, counter-clockwise, and the borders of holes, clockwise. They do not cross or touch.
std::vector<Polygon> convex_decomposition(const std::vector<std::vector<Vec2>>& loops);

/// Returns the convex hull of points, counter-clockwise, without corners on straight sides.
Polygon convex_hull(std::vector<Vec2> points);

}  // namespace retrace::geometry
