#pragma once

// Numbers points of the plane such that points nearer than a tolerance have the same number. This merges vertices.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geometry/vec.h"

namespace retrace::geometry {

/// Merges points of the plane: points that are nearer than the tolerance get the same number. Neighbours are searched
/// in a grid of square cells, which are stored in a hash table.
class VertexIndex {
 public:
  /// \param cell_mm size of the search grid, of the order of the distance between neighbours
  VertexIndex(double tolerance_mm, double cell_mm) : tolerance_mm_(tolerance_mm), cell_mm_(cell_mm) {}

  std::uint32_t add(const Vec2& point);
  const Vec2& operator[](std::uint32_t index) const { return points_[index]; }
  std::size_t size() const { return points_.size(); }

  /// Returns the vertices on the segment from a to b within the tolerance, excluding its ends. They are in order from a
  /// to b.
  std::vector<std::uint32_t> on_segment(std::uint32_t a, std::uint32_t b) const;

 private:
  using Key = std::uint64_t;
  Key key(double x, double y) const;

  double tolerance_mm_;
  double cell_mm_;
  std::vector<Vec2> points_;
  std::unordered_multimap<Key, std::uint32_t> grid_;
};

}  // namespace retrace::geometry
