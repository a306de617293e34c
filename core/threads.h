#pragma once

// Runs work on a limited number of threads, and loops in parallel.

#include <cstddef>
#include <functional>

namespace retrace {

/// Runs `work` with at most `threads` threads (0: all that the process may use; many more than there are cores are not
/// made, they would only cost). What is computed does not depend on it.
void run_with_threads(unsigned threads, const std::function<void()>& work);

/// Calls work(0) .. work(count - 1) in any order, on the threads at hand.
void for_each_in_parallel(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace retrace
