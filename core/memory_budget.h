#pragma once

// Memory budget of the process for beams and for the search structures that find the elements which a beam meets.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/error.h"

namespace retrace {

/// Error that is thrown if the memory budget or the maximum number of beams is exceeded. The same computation may
/// succeed with a larger budget.
class TraceBudgetError : public BudgetError {
 public:
  using BudgetError::BudgetError;
};

/// Returns the memory budget in bytes. The default is 1 GiB.
std::uint64_t memory_budget_bytes();
/// Sets the memory budget.
/// \pre bytes > 0
void set_memory_budget_bytes(std::uint64_t bytes);

/// Returns the maximum memory, in bytes, of the search structures for the elements of one part. It is half of the
/// budget.
std::uint64_t element_memory_bytes();
/// Returns a quarter of the budget in bytes. It is the maximum memory of the beams of one trace. It is also the maximum
/// total memory of all traces that run in parallel, see for_each_within_memory().
std::uint64_t beam_memory_bytes();

/// Returns a text for messages with the size of the budget and the option that changes it, such as "the memory budget
/// of 1 GiB (--memory-gib)".
std::string memory_budget_text();

/// Exception that a trace throws if all traces that run in parallel exceed their common memory limit. The trace may be
/// within its own limit. The caller can therefore repeat the trace while no other trace runs.
struct SharedMemoryExceeded {};

/// Scope in which traces of the current thread are subject to the common memory limit of parallel traces.
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
  /// Checks the common memory limit of parallel traces. Does nothing if this object was created outside of a
  /// SharedMemoryScope.
  /// \throw SharedMemoryExceeded if the beams of all traces within a SharedMemoryScope exceed beam_memory_bytes()
  void require_shared();

 private:
  bool is_shared_;
  std::atomic<std::uint64_t> bytes_{0};
  std::uint64_t reported_bytes_ = 0;  ///< value of `bytes_` that is included in the total of all parallel traces
};

/// Returns the mutex that a trace must lock if it runs outside of a SharedMemoryScope while other traces run in
/// parallel. At most one such trace runs at a time, so its memory is limited to beam_memory_bytes() as well.
std::mutex& exclusive_trace_mutex();

}  // namespace retrace
