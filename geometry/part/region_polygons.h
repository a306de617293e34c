#pragma once

// Subdivides the plane regions of a mesh into few convex polygons. A region that is convex becomes a single polygon,
// however it was triangulated.

#include <cstdint>
#include <vector>

#include "geometry/part/plane_regions.h"

namespace retrace::geometry {

/// A convex polygon that is part of a plane region.
struct RegionPolygon {
  std::uint32_t region = 0;
  std::vector<std::uint32_t> corners;  ///< indices of vertices, counter-clockwise as seen from outside the part
};

/// Triangles and the plane region of each triangle.
struct RegionTriangles {
  std::vector<MeshTriangle> triangles;
  std::vector<std::uint32_t> region_of;
};

/// Removes vertices inside regions and on straight borders between two regions, and fills the gaps with new triangles.
/// \param rounding_mm maximum distance between a vertex and a straight border for the vertex to be removed, mm
RegionTriangles without_redundant_vertices(const std::vector<Vec3>& vertices, RegionTriangles mesh,
                                           const std::vector<FacetPlane>& planes, double rounding_mm);

/// Joins the triangles of each region into convex polygons. Polygons without area are omitted.
std::vector<RegionPolygon> convex_polygons(const std::vector<Vec3>& vertices, const RegionTriangles& mesh,
                                           const std::vector<FacetPlane>& planes);

}  // namespace retrace::geometry
