#pragma once

// The whole boundary of a part as one closed triangle mesh, for export, figures and checks.

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::geometry {

/// A triangle mesh of a part's whole boundary, counter-clockwise seen from outside, each triangle with its role.
struct BoundaryMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<FacetRole> roles;
};

/// The closed boundary of a finite part: back surface, border walls, plate sides, entrance face. Neighbouring triangles
/// share whole edges. \pre the part is finite and its back surface is one patch (up to about 2000 elements)
/// \throw std::logic_error otherwise
BoundaryMesh closed_boundary(const Part& part);

}  // namespace retrace::geometry
