#include "geometry/part/vertex_index.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace retrace::geometry {
namespace {

std::uint64_t cell_key(std::int64_t column, std::int64_t row) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32) | static_cast<std::uint32_t>(row);
}

std::int64_t cell_of(double coordinate, double cell_mm) {
  return static_cast<std::int64_t>(std::floor(coordinate / cell_mm));
}

}  // namespace

VertexIndex::Key VertexIndex::key(double x, double y) const {
  return cell_key(cell_of(x, cell_mm_), cell_of(y, cell_mm_));
}

std::uint32_t VertexIndex::add(const Vec2& point) {
  // A point near a grid line may have an equal point in the next cell. Therefore the cells at the four corners of its
  // tolerance box are searched.
  Key last = 0;
  bool first = true;
  for (const double dx : {-tolerance_mm_, tolerance_mm_}) {
    for (const double dy : {-tolerance_mm_, tolerance_mm_}) {
      const Key k = key(point.x() + dx, point.y() + dy);
      if (!first && k == last) continue;
      first = false;
      last = k;
      const auto [begin, end] = grid_.equal_range(k);
      for (auto it = begin; it != end; ++it)
        if ((points_[it->second] - point).norm() <= tolerance_mm_) return it->second;
    }
  }
  const auto index = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
  grid_.emplace(key(point.x(), point.y()), index);
  return index;
}

std::vector<std::uint32_t> VertexIndex::on_segment(std::uint32_t a, std::uint32_t b) const {
  const Vec2 start = points_[a];
  const Vec2 along = points_[b] - start;
  const double length = along.norm();
  const Vec2 lower = start.cwiseMin(points_[b]).array() - tolerance_mm_;
  const Vec2 upper = start.cwiseMax(points_[b]).array() + tolerance_mm_;
  std::vector<std::pair<double, std::uint32_t>> found;
  for (std::int64_t i = cell_of(lower.x(), cell_mm_); i <= cell_of(upper.x(), cell_mm_); ++i) {
    // Range of cells in this column that the segment crosses.
    double from_mm = lower.y();
    double to_mm = upper.y();
    if (std::abs(along.x()) > tolerance_mm_) {
      const double slope = along.y() / along.x();
      const auto y_at = [&](double x) { return start.y() + slope * (x - start.x()); };
      const double left = y_at(static_cast<double>(i) * cell_mm_ - tolerance_mm_);
      const double right = y_at(static_cast<double>(i + 1) * cell_mm_ + tolerance_mm_);
      from_mm = std::max(from_mm, std::min(left, right) - tolerance_mm_);
      to_mm = std::min(to_mm, std::max(left, right) + tolerance_mm_);
    }
    for (std::int64_t j = cell_of(from_mm, cell_mm_); j <= cell_of(to_mm, cell_mm_); ++j) {
      const auto [begin, end] = grid_.equal_range(cell_key(i, j));
      for (auto it = begin; it != end; ++it) {
        if (it->second == a || it->second == b) continue;
        const Vec2 d = points_[it->second] - start;
        const double s = d.dot(along) / length;
        const double off = std::abs(along.x() * d.y() - along.y() * d.x()) / length;
        if (off <= tolerance_mm_ && s > tolerance_mm_ && s < length - tolerance_mm_) found.emplace_back(s, it->second);
      }
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::uint32_t> order;
  order.reserve(found.size());
  for (const auto& [s, index] : found) order.push_back(index);
  return order;
}

}  // namespace retrace::geometry
