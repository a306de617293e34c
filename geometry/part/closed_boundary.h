#pragma once

// Builds the complete boundary of a part as one closed triangle mesh, for export, figures and checks.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::geometry {

/// Triangle mesh of a part's complete boundary. Triangles run counter-clockwise as seen from outside. Each triangle has
/// a role.
struct BoundaryMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<FacetRole> roles;
};

/// Adds the triangles that join the edges of a closed polygon of vertices to its centroid.
void add_fan(BoundaryMesh& mesh, const std::vector<std::uint32_t>& ring, FacetRole role);

/// Returns the directed edges of the triangles that have no opposite edge in any triangle, in the order of the
/// triangles.
std::vector<std::pair<std::uint32_t, std::uint32_t>> open_edges(const BoundaryMesh& mesh);

/// Returns the back surface and the border walls of a finite part. The returned mesh is open, because the sides and the
/// entrance face are missing.
/// \pre the preconditions of closed_boundary()
/// \throw std::logic_error under the same conditions as closed_boundary()
BoundaryMesh back_boundary(const Part& part);

/// Returns the closed boundary of a finite part: back surface, border walls, sides of the plate and entrance face.
/// Neighbouring triangles share complete edges.
/// \pre the part is finite, and its back surface is a single patch (up to about 2000 elements)
/// \throw std::logic_error if the part is infinite or has several patches
BoundaryMesh closed_boundary(const Part& part);

}  // namespace retrace::geometry
