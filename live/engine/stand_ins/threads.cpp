// Replaces TBB: the live page computes in a single worker thread.
#include "core/threads.h"

namespace retrace {

void run_with_threads(unsigned, const std::function<void()>& work) {
  work();
}

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t k = 0; k < count; ++k) work(k);
}

}  // namespace retrace
