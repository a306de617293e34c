#include "core/threads.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <thread>

namespace retrace {

void run_with_threads(unsigned threads, const std::function<void()>& work) {
  if (threads == 0) {
    work();
    return;
  }
  const unsigned useful = std::min(threads, std::max(8U, 4 * std::thread::hardware_concurrency()));
  // By default, TBB limits the number of threads to the number of cores. This object allows a larger number.
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, useful);
  tbb::task_arena arena(static_cast<int>(useful));
  arena.execute(work);
}

namespace {

/// A parallel loop. TBB is built without ThreadSanitizer, which therefore does not see how TBB passes work to threads
/// and waits for them. Two atomics make this synchronisation visible, so that ThreadSanitizer reports only real data
/// races.
struct Loop {
  explicit Loop(const std::function<void(std::size_t)>& its_work) : work(its_work) {
    handed_out.fetch_add(1, std::memory_order_release);
  }
  ~Loop() { static_cast<void>(handed_back.load(std::memory_order_acquire)); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  const std::function<void(std::size_t)>& work;
  std::atomic<unsigned> handed_out{0};
  std::atomic<unsigned> handed_back{0};
};

/// Marks the execution of a part of a loop by one thread. The destructor marks the end of the execution, even if the
/// part throws an exception.
class Piece {
 public:
  explicit Piece(Loop& loop) : loop_(loop) { static_cast<void>(loop_.handed_out.load(std::memory_order_acquire)); }
  ~Piece() { loop_.handed_back.fetch_add(1, std::memory_order_release); }
  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;

 private:
  Loop& loop_;
};

}  // namespace

void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  Loop loop(work);
  // While a thread waits for other threads of this loop, isolate() lets it execute only parts of this loop. It must not
  // start parts of an enclosing parallel loop.
  tbb::this_task_arena::isolate([&loop, count] {
    using Range = tbb::blocked_range<std::size_t>;
    // The lambda captures one pointer, which TBB copies without memcpy. Larger captures would be copied with memcpy.
    // ThreadSanitizer would report these copies, and tests/tsan.supp could not suppress them without also suppressing
    // other calls of memcpy.
    tbb::parallel_for(Range(0, count), [&loop](const Range& range) {
      const Piece piece(loop);
      for (std::size_t k = range.begin(); k < range.end(); ++k) loop.work(k);
    });
  });
}

}  // namespace retrace
