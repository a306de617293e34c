#pragma once

// Finds the plane facets of a triangle mesh. How a facet is triangulated has no effect on the result.

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace retrace::geometry {

using MeshTriangle = std::array<std::uint32_t, 3>;

/// The plane of all points p with normal . p = offset_mm. The normal has length 1 and points out of the part.
struct FacetPlane {
  Vec3 normal = Vec3::UnitZ();
  double offset_mm = 0.0;

  double height(const Vec3& p) const { return normal.dot(p) - offset_mm; }
};

/// Constraint on the plane of a region. Rounding errors make the normal of a narrow strip uncertain. If the deviation
/// of the plane from the vertical or from the horizontal is less than this uncertainty, the plane is made exactly
/// vertical or horizontal.
enum class PlaneKind : std::uint8_t {
  any,        ///< no constraint
  vertical,   ///< vertical
  horizontal  ///< horizontal
};

/// Plane regions of a mesh. A region is a set of triangles in one plane that are connected through shared edges.
struct PlaneRegions {
  std::vector<std::uint32_t> region_of;  ///< region of each triangle
  std::vector<FacetPlane> planes;        ///< plane of each region
  std::vector<PlaneKind> kinds;          ///< constraint on the plane of each region
};

/// Projection matrix onto the directions in which a vertex may move.
using VertexConstraint = Eigen::Matrix3d;

/// Groups triangles into plane regions. A region grows from one triangle. An adjacent triangle joins the region if all
/// its vertices are near the region's plane. The distance of a vertex must be at most `rounding_mm` plus the
/// uncertainty of the plane at this vertex.
/// \param rounding_mm maximum error of a vertex, mm
PlaneRegions plane_regions(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
                           double rounding_mm);

/// Moves the vertices onto the planes of their regions, then fits the planes to the moved vertices. These two steps are
/// repeated until all vertices are on their planes or a maximum number of rounds is reached.
/// \param freedom directions in which each vertex may move
/// \param regions regions of the triangles; their planes are updated
void snap_to_planes(std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
                    const std::vector<VertexConstraint>& freedom, PlaneRegions& regions);

/// Merges vertices that are connected by edges shorter than `limit_mm`. Triangles with two merged corners are removed.
void weld_short_edges(const std::vector<Vec3>& vertices, double limit_mm, std::vector<MeshTriangle>& triangles);

}  // namespace retrace::geometry
