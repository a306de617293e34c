#pragma once

// Triangle meshes as solids with plane polygonal faces, as CAD formats have them, and the volume and area of meshes.

#include <cstdint>
#include <vector>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// One plane face of a solid: an outline and the holes in it.
struct SolidFace {
  Vec3 normal = Vec3::UnitZ();              ///< unit, out of the solid
  FacetRole role = FacetRole::retro_facet;  ///< of its first triangle
  /// Vertex numbers. The first loop is the outline, counter-clockwise seen from outside; holes run the other way.
  std::vector<std::vector<std::uint32_t>> loops;
};

/// A solid bounded by plane polygons. Every edge belongs to exactly two faces, which pass it in opposite directions.
struct FacetedSolid {
  std::vector<Vec3> vertices;
  std::vector<SolidFace> faces;
};

/// The enclosed volume (divergence theorem), positive if triangles are counter-clockwise seen from outside.
double volume_mm3(const BoundaryMesh& mesh);
/// The area of all triangles.
double area_mm2(const BoundaryMesh& mesh);

/// Whether every edge is passed exactly once in either direction: the mesh is closed and touches itself along no edge.
bool is_closed_manifold(const BoundaryMesh& mesh);

/// Triangles that lie in one plane and are neighbours become one face, and vertices within straight edges go.
/// A face whose outline would touch itself stays in triangles.
/// \param mesh is_closed_manifold() \throw std::logic_error otherwise
FacetedSolid faceted_solid(const BoundaryMesh& mesh);

}  // namespace retrace::geometry
