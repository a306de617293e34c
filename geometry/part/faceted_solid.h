#pragma once

// Converts triangle meshes to solids with plane polygonal faces, as CAD formats use them. Computes the volume and area
// of meshes.

#include <cstdint>
#include <vector>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// Plane face of a solid: an outline and its holes.
struct SolidFace {
  Vec3 normal = Vec3::UnitZ();              ///< unit vector, out of the solid
  FacetRole role = FacetRole::retro_facet;  ///< role of the face's first triangle
  /// Vertex indices. The first loop is the outline, counter-clockwise as seen from outside. The other loops are holes,
  /// in the opposite direction.
  std::vector<std::vector<std::uint32_t>> loops;
};

/// Solid bounded by plane polygons. Every edge belongs to exactly two faces, which traverse it in opposite directions.
struct FacetedSolid {
  std::vector<Vec3> vertices;
  std::vector<SolidFace> faces;
};

/// Returns the enclosed volume (divergence theorem). It is positive if triangles are counter-clockwise as seen from
/// outside.
double volume_mm3(const BoundaryMesh& mesh);
/// Returns the total area of all triangles.
double area_mm2(const BoundaryMesh& mesh);

/// Returns true if every edge is traversed exactly once in each direction. The mesh is then closed, and no edge is
/// shared by more than two triangles.
bool is_closed_manifold(const BoundaryMesh& mesh);

/// Joins neighbouring triangles in the same plane to form faces, and removes vertices on straight edges. Triangles are
/// not joined if the outline of the face would touch itself.
/// \param mesh a mesh for which is_closed_manifold() is true
/// \throw std::logic_error for other meshes
FacetedSolid faceted_solid(const BoundaryMesh& mesh);

}  // namespace retrace::geometry
