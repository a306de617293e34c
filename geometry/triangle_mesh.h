#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace retrace::geometry {

/// Triangles without roles, vertices welded.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace retrace::geometry
