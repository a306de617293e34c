#include "raytrace/exact/element_memory.h"

#include <fmt/format.h>

#include "core/memory_budget.h"

namespace retrace::raytrace {
namespace {

/// Memory in bytes per cell. It includes the lookup table in which TranslationalSymmetry finds identical cells, and
/// about five entries in CellIndex, because a cell usually overlaps several buckets.
constexpr double kBytesPerCell = 150.0;
/// Memory in bytes per bucket of CellIndex. Cells that are much longer than wide overlap many buckets.
constexpr double kBytesPerBucket = 24.0;
/// Time needed to add a cell to the index and to compare it with its neighbours, in units of ElementCost::work; about
/// 1.2 us.
constexpr double kWorkPerCell = 40.0;

double bucket_count(const geometry::Part& part) {
  if (part.period_mm) return 0.0;
  const geometry::Vec2 size = geometry::bounding_box(part.outline).size() / part.size_mm;
  return size.x() * size.y();
}

}  // namespace

bool ElementCost::fits_memory() const {
  return bytes <= static_cast<double>(element_memory_bytes());
}

ElementCost element_cost(const geometry::Part& part) {
  ElementCost cost;
  for (const geometry::Placement& placement : part.placements)
    cost.cells += static_cast<double>(part.patches[placement.patch].cells.size());
  cost.bytes = kBytesPerCell * cost.cells + kBytesPerBucket * bucket_count(part);
  cost.work = kWorkPerCell * cost.cells;
  return cost;
}

void require_element_memory(const geometry::Part& part) {
  const ElementCost cost = element_cost(part);
  if (cost.fits_memory()) return;
  throw TraceBudgetError(fmt::format(
      "beams through {:.3g} cells take about {:.3g} GiB, which exceeds half of {}: use a larger memory budget, or {} "
      "montecarlo",
      cost.cells, cost.bytes / static_cast<double>(1U << 30), memory_budget_text(), reference({"engine"})));
}

}  // namespace retrace::raytrace
