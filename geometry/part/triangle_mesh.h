#pragma once

// The plain triangle mesh, as read from files and handed between the rooms of geometry.

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

/// A key that tells the edge of a mesh from one vertex to another from all its other edges, the opposite one included.
inline std::uint64_t directed_edge(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32) | to;
}

}  // namespace retrace::geometry
