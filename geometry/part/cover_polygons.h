#pragma once

// Covers a plane region of a mesh with triangles. The triangles use all vertices of the mesh on the border of the
// region, so that no gaps remain.

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// Vertex of a mesh and its position in plan.
using PlacedVertex = std::pair<Vec2, std::uint32_t>;

/// Adds triangles that cover convex polygons at the height of `vertices`.
/// \param vertices all vertices of the mesh on the borders of the polygons
/// \param size_mm size of an element, for tolerances
/// \param faces_up true if the triangles face +z
void add_cover(BoundaryMesh& mesh, const std::vector<Polygon>& polygons, const std::vector<PlacedVertex>& vertices,
               double size_mm, FacetRole role, bool faces_up);

}  // namespace retrace::geometry
