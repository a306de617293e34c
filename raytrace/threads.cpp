#include "raytrace/threads.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace retrace::raytrace {

void run_with_threads(unsigned threads, const std::function<void()>& work) {
  if (threads == 0) {
    work();
    return;
  }
  const unsigned useful = std::min(threads, std::max(8U, 4 * std::thread::hardware_concurrency()));
  // TBB's own limit is the number of cores; asking for more is allowed.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, useful);
  tbb::task_arena arena(static_cast<int>(useful));
  arena.execute(work);
}

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  tbb::parallel_for(std::size_t{0}, count, work);
}

}  // namespace retrace::raytrace
