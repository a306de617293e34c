#pragma once

// Work that is divided into numbered, independent tasks, so that several processes can share it.

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"

namespace retrace {

/// Function that computes a task and returns its result as bytes, or nothing if it was cancelled. Several threads may
/// call it at the same time.
/// \throw Error
using ComputeTask = std::function<std::optional<std::string>(std::uint64_t task, const Cancellation* cancel)>;

/// List of the tasks that are to be computed, and of their results. One process owns the list. Only one thread at a
/// time may call its functions.
class TaskLedger {
 public:
  virtual ~TaskLedger() = default;
  /// Returns the next task and marks it as taken. Returns nothing if no task is available at present.
  virtual std::optional<std::uint64_t> take() = 0;
  /// Returns a task, which was taken but not finished, to the list of available tasks.
  virtual void give_back(std::uint64_t task) = 0;
  /// Stores the result of a task that was taken.
  /// \param bytes result of ComputeTask
  virtual void finish(std::uint64_t task, const std::string& bytes) = 0;
  /// Returns true if all tasks are finished. If it returns false, take() returns the tasks that are to be computed
  /// next.
  /// \pre no task is taken
  virtual bool is_finished() = 0;
};

/// Function that computes all tasks of a ledger.
/// \return true if all tasks are finished, false if the work was cancelled
/// \throw Error
using DistributeTasks = std::function<bool(const ComputeTask& compute, TaskLedger& ledger)>;

/// Converts numbers to bytes, for the result of a task.
inline std::string bytes_of(const std::vector<double>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}
/// Converts the bytes of bytes_of() to numbers.
inline std::vector<double> numbers_of(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  return numbers;
}

}  // namespace retrace
