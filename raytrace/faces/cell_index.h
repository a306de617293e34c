#pragma once

// A grid over the cells of the back surface, with which the exact engine finds the cells under a beam.

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Finds the cells of the back surface near a position. For an infinite part, it stores the central period.
class CellIndex {
 public:
  /// \param centre_mm point of the plane z = 0 that becomes the origin
  CellIndex(const geometry::Part& part, const geometry::Vec2& centre_mm);

  /// Calls visit(patch, cell, offset, height_mm) one time for every cell whose box overlaps the rectangle. `offset` and
  /// `height_mm` displace the patch's coordinates to the position of the cell.
  template <class Visit>
  void visit(const geometry::Vec2& lower, const geometry::Vec2& upper, const Visit& visit) const {
    if (infinite_)
      visit_periodic(lower, upper, visit);
    else
      visit_finite(lower, upper, visit);
  }

 private:
  struct Entry {
    std::uint32_t placement = 0;
    std::uint32_t cell = 0;
  };

  const geometry::PatchCell& cell_of(const Entry& e) const {
    return part_.patches[part_.placements[e.placement].patch].cells[e.cell];
  }
  geometry::Vec2 offset_of(const Entry& e) const { return part_.placements[e.placement].offset_mm - centre_mm_; }
  std::int64_t bucket(double coordinate, Eigen::Index axis) const {
    const auto k = static_cast<std::int64_t>(std::floor((coordinate - origin_[axis]) / bucket_mm_));
    return std::clamp<std::int64_t>(k, 0, count_[static_cast<std::size_t>(axis)] - 1);
  }

  template <class Visit>
  void visit_periodic(const geometry::Vec2& lower, const geometry::Vec2& upper, const Visit& visit) const {
    const geometry::Vec2& period = *part_.period_mm;
    for (const Entry& e : central_) {
      const auto& cell = cell_of(e);
      const geometry::Vec2 offset = offset_of(e);
      const geometry::Vec2 first = (lower - offset - cell.upper.head<2>()).cwiseQuotient(period);
      const geometry::Vec2 last = (upper - offset - cell.lower.head<2>()).cwiseQuotient(period);
      for (auto j = static_cast<std::int64_t>(std::ceil(first.y())); static_cast<double>(j) <= last.y(); ++j)
        for (auto i = static_cast<std::int64_t>(std::ceil(first.x())); static_cast<double>(i) <= last.x(); ++i)
          visit(part_.patches[part_.placements[e.placement].patch], cell,
                geometry::Vec2(offset.x() + static_cast<double>(i) * period.x(),
                               offset.y() + static_cast<double>(j) * period.y()),
                0.0);
    }
  }

  template <class Visit>
  void visit_finite(const geometry::Vec2& lower, const geometry::Vec2& upper, const Visit& visit) const {
    const std::int64_t i0 = bucket(lower.x(), 0);
    const std::int64_t j0 = bucket(lower.y(), 1);
    const std::int64_t i1 = bucket(upper.x(), 0);
    const std::int64_t j1 = bucket(upper.y(), 1);
    for (std::int64_t j = j0; j <= j1; ++j)
      for (std::int64_t i = i0; i <= i1; ++i) {
        const auto b = static_cast<std::size_t>(j * count_[0] + i);
        for (std::uint32_t k = first_[b]; k < first_[b + 1]; ++k) {
          const Entry& e = entries_[k];
          const auto& cell = cell_of(e);
          const geometry::Vec2 offset = offset_of(e);
          const geometry::Vec2 low = cell.lower.head<2>() + offset;
          const geometry::Vec2 high = cell.upper.head<2>() + offset;
          if ((low.array() > upper.array()).any() || (high.array() < lower.array()).any()) continue;
          // A cell is listed in every bucket that it overlaps. To visit it only one time, it is visited in the first of
          // these buckets that the query covers.
          if (std::max(bucket(low.x(), 0), i0) != i || std::max(bucket(low.y(), 1), j0) != j) continue;
          visit(part_.patches[part_.placements[e.placement].patch], cell, offset,
                part_.placements[e.placement].height_mm);
        }
      }
  }

  const geometry::Part& part_;
  geometry::Vec2 centre_mm_;
  bool infinite_ = false;
  std::vector<Entry> central_;  ///< infinite parts: cells of the central period
  geometry::Vec2 origin_ = geometry::Vec2::Zero();
  double bucket_mm_ = 1.0;
  std::int64_t count_[2] = {1, 1};
  std::vector<std::uint32_t> first_;  ///< index of the first entry of each bucket, followed by the total number of
                                      ///< entries
  std::vector<Entry> entries_;
};

}  // namespace retrace::raytrace
