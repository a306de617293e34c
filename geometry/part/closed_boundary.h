#pragma once

// Builds the complete boundary of a part as one closed triangle mesh, for export, figures and checks.

#include <array>
#include <cstdint>
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

/// Returns the closed boundary of a finite part: back surface, border walls, sides of the plate and entrance face.
/// Neighbouring triangles share complete edges.
/// \pre the part is finite, and its back surface is a single patch (up to about 2000 elements)
/// \throw std::logic_error if the part is infinite or has several patches
BoundaryMesh closed_boundary(const Part& part);

}  // namespace retrace::geometry
