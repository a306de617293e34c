#pragma once

// Parallel loop over traces whose total memory is limited.

#include <cstddef>
#include <functional>
#include <mutex>

#include "core/memory_budget.h"
#include "core/threads.h"

namespace retrace {

/// Calls work(0), ..., work(count - 1) in parallel, like for_each_in_parallel(). If the parallel calls together exceed
/// their common memory limit, the call that detects this is aborted and repeated outside of the common limit. Only one
/// repeated call runs at a time. The results do not depend on the number of threads.
/// \pre `work` can be called again after it has thrown SharedMemoryExceeded
inline void for_each_within_memory(std::size_t count, const std::function<void(std::size_t)>& work) {
  const auto fits_beside_others = [&work](std::size_t k) {
    const SharedMemoryScope scope;
    try {
      work(k);
      return true;
    } catch (const SharedMemoryExceeded&) {
      return false;
    }
  };
  for_each_in_parallel(count, [&](std::size_t k) {
    if (fits_beside_others(k)) return;
    const std::lock_guard alone(exclusive_trace_mutex());
    work(k);
  });
}

}  // namespace retrace
