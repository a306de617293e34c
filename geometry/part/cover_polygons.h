#pragma once

// Covers a plane region of a closed mesh with triangles that share all vertices on its border.

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// Vertex of a mesh and its position in plan.
using PlacedVertex = std::pair<Vec2, std::uint32_t>;

/// Returns the border of a convex polygon as vertices, counter-clockwise. Vertices on its sides are included.
/// \param tolerance_mm maximum distance between a vertex and the side on which it is
std::vector<std::uint32_t> border_vertices(const Polygon& polygon, const std::vector<PlacedVertex>& vertices,
                                           double tolerance_mm);

/// Adds triangles that cover convex polygons at a height.
/// \param vertices all vertices on the border of the region at this height
/// \param faces_up true if the triangles face +z
void add_cover(BoundaryMesh& mesh, const std::vector<Polygon>& polygons, const std::vector<PlacedVertex>& vertices,
               double tolerance_mm, FacetRole role, bool faces_up);

}  // namespace retrace::geometry
