#include "raytrace/faces/cell_index.h"

#include <algorithm>
#include <numeric>

namespace retrace::raytrace {

using geometry::Vec2;

CellIndex::CellIndex(const geometry::Part& part, const Vec2& centre_mm) : part_(part), centre_mm_(centre_mm) {
  if (part.period_mm) {
    infinite_ = true;
    // The patch of an infinite part contains several periods, stored row by row. Only the cells of the central period
    // are stored here.
    const auto side = static_cast<std::uint32_t>(2 * part.periods_beyond + 1);
    const auto each = static_cast<std::uint32_t>(part.patches[0].cells.size()) / (side * side);
    const std::uint32_t first = (side * side / 2) * each;
    for (std::uint32_t k = 0; k < each; ++k) central_.push_back({0, first + k});
    return;
  }
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  origin_ = box.lower - centre_mm;
  bucket_mm_ = part.size_mm;
  for (const Eigen::Index axis : {0, 1})
    count_[axis] = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(box.size()[axis] / bucket_mm_)));

  const auto visit_all = [&](const auto& visit) {
    for (std::uint32_t p = 0; p < part.placements.size(); ++p) {
      const auto& cells = part.patches[part.placements[p].patch].cells;
      for (std::uint32_t c = 0; c < cells.size(); ++c) {
        const Vec2 offset = part.placements[p].offset_mm - centre_mm;
        const Vec2 low = cells[c].lower.head<2>() + offset;
        const Vec2 high = cells[c].upper.head<2>() + offset;
        for (std::int64_t j = bucket(low.y(), 1); j <= bucket(high.y(), 1); ++j)
          for (std::int64_t i = bucket(low.x(), 0); i <= bucket(high.x(), 0); ++i)
            visit(static_cast<std::size_t>(j * count_[0] + i), Entry{p, c});
      }
    }
  };
  // The entries per bucket are counted first, so that the memory is allocated in one step.
  first_.resize(static_cast<std::size_t>(count_[0] * count_[1]) + 1);
  visit_all([&](std::size_t bucket, const Entry&) { ++first_[bucket + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  visit_all([&](std::size_t bucket, const Entry& entry) { entries_[next[bucket]++] = entry; });
}

}  // namespace retrace::raytrace
