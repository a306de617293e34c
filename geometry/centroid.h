#pragma once

// Centroids of polygons in the plane and in space. In contrast to the average of the corners, a centroid does not
// change if a vertex is inserted in an edge.

#include <cstdint>
#include <span>

#include "geometry/vec.h"

namespace retrace::geometry {

/// Returns the centroid of a polygon's area. If the area is 0 within rounding errors, the centroid of the border
/// polyline is returned. If all corners coincide, their common position is returned. The result is within the bounding
/// box of the corners.
/// \param corners at least one, in order along the border
Vec2 centroid(std::span<const Vec2> corners);

/// Returns the centroid of a polygon in space. The corners need not be exactly coplanar: areas are measured in the
/// projection along the mean normal.
/// \param corners at least one, in order along the border
Vec3 centroid(std::span<const Vec3> corners);

/// Returns the centroid of a polygon whose corners are given as indices of vertices.
/// \param ring indices of the corners in `vertices`; at least one, in order along the border
Vec3 ring_centroid(std::span<const Vec3> vertices, std::span<const std::uint32_t> ring);

}  // namespace retrace::geometry
