#pragma once

// A plain triangle mesh. It is read from files and passed between the folders of geometry.

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace retrace::geometry {

/// Triangle mesh. Vertices at the same position are merged. In contrast to a BoundaryMesh, triangles have no roles
/// (such as entrance face or side).
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Returns a key that identifies a directed edge of a mesh. An edge and its opposite edge have different keys.
inline std::uint64_t directed_edge(std::uint32_t from, std::uint32_t to) {
  return (static_cast<std::uint64_t>(from) << 32) | to;
}

}  // namespace retrace::geometry
