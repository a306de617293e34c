#pragma once

// Memory budget of beams and of the structures in which they find elements. All threads of the process share it.

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

/// Maximum memory in bytes of the structures that find the elements of one part: half of the budget.
std::uint64_t element_memory_bytes();
/// Maximum memory in bytes of the beams of one trace: a quarter of the budget. Traces that run in parallel share
/// another quarter, see for_each_within_memory().
std::uint64_t beam_memory_bytes();

/// Returns the size of the budget and the option that changes it, for messages.
std::string memory_budget_text();

/// Thrown if parallel traces together exceed the memory that they share, although this trace by itself does not.
struct SharedMemoryShort {};

/// Makes the traces of the current thread share their memory with those of other threads.
class SharedMemoryScope {
 public:
  SharedMemoryScope();
  ~SharedMemoryScope();
  SharedMemoryScope(const SharedMemoryScope&) = delete;
  SharedMemoryScope& operator=(const SharedMemoryScope&) = delete;

 private:
  bool was_shared_;
};

/// Memory that the beams of one trace occupy.
class BeamMemory {
 public:
  BeamMemory();
  ~BeamMemory();
  BeamMemory(const BeamMemory&) = delete;
  BeamMemory& operator=(const BeamMemory&) = delete;

  void add(std::uint64_t bytes);
  void remove(std::uint64_t bytes);
  /// Returns true if this trace by itself exceeds beam_memory_bytes().
  bool is_exceeded() const;
  /// Checks the memory that parallel traces share. Does nothing outside of a SharedMemoryScope.
  /// \throw SharedMemoryShort if all traces within a SharedMemoryScope together exceed beam_memory_bytes()
  void require_shared();

 private:
  bool is_shared_;
  std::atomic<std::uint64_t> bytes_{0};
  std::uint64_t reported_bytes_ = 0;  ///< part of `bytes_` that was added to the total of all threads
};

/// Returns the mutex that a trace outside of any SharedMemoryScope locks while other traces run within such scopes. At
/// most one such trace runs at a time.
std::mutex& lone_trace_mutex();

}  // namespace retrace
