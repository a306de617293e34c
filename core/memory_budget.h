#pragma once

// Memory budget for beams and for the search structures that find the elements which a beam meets. All threads of the
// process share this budget.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/error.h"

namespace retrace {

/// Error: the budget of memory or of beams is exhausted. The same work may succeed with a larger budget.
class TraceBudgetError : public BudgetError {
 public:
  using BudgetError::BudgetError;
};

/// Memory budget in bytes. The default is 1 GiB.
std::uint64_t memory_budget_bytes();
/// \pre bytes > 0
void set_memory_budget_bytes(std::uint64_t bytes);

/// Maximum memory, in bytes, of the search structures for the elements of one part: half of the budget.
std::uint64_t element_memory_bytes();
/// Maximum memory, in bytes, of the beams of one trace: a quarter of the budget. Traces that run in parallel may
/// together use another quarter, see for_each_within_memory().
std::uint64_t beam_memory_bytes();

/// Returns the size of the budget and the name of the option that changes it, for messages.
std::string memory_budget_text();

/// Exception: the traces that run in parallel exceed their common memory limit, but this trace does not exceed its own.
struct SharedMemoryShort {};

/// While an object exists, traces of the current thread count towards the memory limit that is common to all parallel
/// traces.
class SharedMemoryScope {
 public:
  SharedMemoryScope();
  ~SharedMemoryScope();
  SharedMemoryScope(const SharedMemoryScope&) = delete;
  SharedMemoryScope& operator=(const SharedMemoryScope&) = delete;

 private:
  bool was_shared_;
};

/// Counts the memory of the beams of one trace.
class BeamMemory {
 public:
  BeamMemory();
  ~BeamMemory();
  BeamMemory(const BeamMemory&) = delete;
  BeamMemory& operator=(const BeamMemory&) = delete;

  void add(std::uint64_t bytes);
  void remove(std::uint64_t bytes);
  /// Returns true if this trace exceeds beam_memory_bytes().
  bool is_exceeded() const;
  /// Checks the common memory limit of parallel traces. Does nothing outside of a SharedMemoryScope.
  /// \throw SharedMemoryShort if the beams of all traces within a SharedMemoryScope exceed beam_memory_bytes()
  void require_shared();

 private:
  bool is_shared_;
  std::atomic<std::uint64_t> bytes_{0};
  std::uint64_t reported_bytes_ = 0;  ///< part of `bytes_` that is already included in the total of all threads
};

/// Returns the mutex for traces that run outside of any SharedMemoryScope, in parallel with traces inside of such
/// scopes. The mutex ensures that at most one such trace runs at a time.
std::mutex& lone_trace_mutex();

}  // namespace retrace
