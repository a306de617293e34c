#include "geometry/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "geometry/io/obj_file.h"
#include "geometry/io/stl_file.h"

namespace retrace::geometry {
namespace {

/// Returns a size of cubes such that few vertices are in a cube, but not less than `least_mm`.
double grid_size_mm(const std::vector<Vec3>& vertices, double least_mm) {
  if (vertices.empty()) return 1.0;
  Vec3 lower = vertices.front();
  Vec3 upper = lower;
  for (const Vec3& p : vertices) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const double size_mm = (upper - lower).maxCoeff() / std::sqrt(static_cast<double>(vertices.size()));
  return std::max({least_mm, size_mm, 1e-9});
}

/// Merges vertices. Neighbours are searched in a grid of cubes.
class VertexMerger {
 public:
  VertexMerger(const std::vector<Vec3>& vertices, double tolerance_mm)
      : vertices_(vertices),
        tolerance_mm_(tolerance_mm),
        cell_mm_(grid_size_mm(vertices, 2.0 * tolerance_mm)),
        same_as_(vertices.size()) {
    std::iota(same_as_.begin(), same_as_.end(), 0U);
    for (std::uint32_t v = 0; v < vertices.size(); ++v) add(v);
  }

  std::uint32_t first_of(std::uint32_t v) {
    while (same_as_[v] != v) v = same_as_[v] = same_as_[same_as_[v]];
    return v;
  }

 private:
  using CellKey = std::array<std::int64_t, 3>;

  CellKey key_of(const Vec3& p) const {
    CellKey key{};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      key.at(static_cast<std::size_t>(axis)) = static_cast<std::int64_t>(std::floor(p[axis] / cell_mm_));
    return key;
  }

  void add(std::uint32_t v) {
    const Vec3& p = vertices_[v];
    // The neighbours within the tolerance are in at most eight cells.
    std::vector<CellKey> keys;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 sign(corner % 2 == 0 ? -1.0 : 1.0, corner / 2 % 2 == 0 ? -1.0 : 1.0, corner / 4 == 0 ? -1.0 : 1.0);
      keys.push_back(key_of(p + tolerance_mm_ * sign));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const CellKey& key : keys) {
      const auto found = grid_.find(key);
      if (found == grid_.end()) continue;
      for (const std::uint32_t other : found->second)
        if ((vertices_[other] - p).norm() <= tolerance_mm_) join(other, v);
    }
    grid_[key_of(p)].push_back(v);
  }

  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t first_a = first_of(a);
    const std::uint32_t first_b = first_of(b);
    same_as_[std::max(first_a, first_b)] = std::min(first_a, first_b);
  }

  const std::vector<Vec3>& vertices_;
  double tolerance_mm_;
  double cell_mm_;
  std::vector<std::uint32_t> same_as_;
  std::map<CellKey, std::vector<std::uint32_t>> grid_;
};

}  // namespace

TriangleMesh welded(const TriangleMesh& mesh, double tolerance_mm) {
  VertexMerger merger(mesh.vertices, tolerance_mm);
  TriangleMesh result;
  std::vector<std::uint32_t> number(mesh.vertices.size(), UINT32_MAX);
  for (const auto& triangle : mesh.triangles) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners.at(k) = merger.first_of(triangle.at(k));
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (std::uint32_t& v : corners) {
      if (number[v] == UINT32_MAX) {
        number[v] = static_cast<std::uint32_t>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(corners);
  }
  return result;
}

MeshOfFile read_mesh_file(const std::filesystem::path& file, double scale) {
  MeshOfFile read;
  if (ending_of(file.string()) == ".obj") {
    read.mesh = welded(parse_obj(read_file(file, kMaxDataBytes), file.string(), scale), 0.0);
    if (read.mesh.triangles.empty()) throw InputError({file.string(), 0, ""}, "all faces of the mesh have zero area");
  } else {
    read.mesh = read_stl(file, scale, &read.trailing_bytes);
  }
  return read;
}

}  // namespace retrace::geometry
