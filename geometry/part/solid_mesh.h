#pragma once

// Triangles of the solids in a CAD file, with the exact planes of their plane faces.

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/part/plane_regions.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Triangle mesh of one or more solids. Triangles of one face are in the same plane if the face is plane. Different
/// solids share no vertices.
struct SolidMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> face_of;             ///< number of the face of each triangle
  std::vector<std::optional<FacetPlane>> planes;  ///< plane of each face; empty for curved faces
  std::size_t solids = 0;                         ///< number of solids

  std::size_t curved_faces() const;
};

/// Moves each vertex onto the planes of its plane faces. Orients the planes such that their normals agree with their
/// triangles. Vertices that are farther from a plane than `max_move_mm` are not moved.
/// \return maximum distance between a vertex and a plane of its faces after the movement
double snap_to_face_planes(SolidMesh& solid, double max_move_mm);

}  // namespace retrace::geometry
