#pragma once

// Computes the boolean union of the bodies of a mesh with the exact constructions of CGAL. The bodies may intersect or
// contain each other.

#include <cstddef>
#include <optional>

#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Union of the bodies of a mesh.
struct MeshUnion {
  TriangleMesh mesh;
  std::size_t bodies = 0;  ///< number of bodies of the original mesh
};

/// Returns the union of the bodies of a mesh. A body is a set of triangles that are connected through shared edges.
/// Returns nothing if the mesh has only one body, if a body intersects itself or has inward normals, or if the union
/// would not be manifold.
/// \pre the mesh is closed and manifold
std::optional<MeshUnion> union_of_bodies(const TriangleMesh& mesh);

}  // namespace retrace::geometry
