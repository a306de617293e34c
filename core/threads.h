#pragma once

// Runs work with a limited number of threads, and runs loops in parallel.

#include <cstddef>
#include <functional>

namespace retrace {

/// Runs `work` with at most `threads` threads. 0 means all threads that the process may use. The number is limited to 8
/// or to 4 times the number of cores, whichever is larger. Results do not depend on the number of threads.
void run_with_threads(unsigned threads, const std::function<void()>& work);

/// Calls work(0), ..., work(count - 1) in any order, with all available threads.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace retrace
