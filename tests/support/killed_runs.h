#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "compute/store/store.h"

namespace retrace::testing {

/// Calls `check` with stores that killed runs may have left.
/// \param points points of a complete run
template <class Check>
void for_each_killed_run(const std::vector<compute::StoredPoint>& points, const compute::StoreLayout& layout,
                         const Check& check) {
  std::mt19937 random(30);
  for (int kill = 0; kill < 20; ++kill) {
    // Up to eight points are computed in parallel. If a run is killed, the store may lack some of the last eight points
    // that the run started.
    const std::size_t begun = random() % points.size();
    compute::ResultStore left("", layout, compute::IfExists::refuse);
    for (std::size_t k = 0; k < begun; ++k)
      if (k + 8 < begun || random() % 2 == 0) left.record(points[k]);
    SCOPED_TRACE("killed after " + std::to_string(begun) + " points");
    check(left);
  }
}

}  // namespace retrace::testing
