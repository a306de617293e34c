#pragma once

// Work in numbered tasks that do not depend on each other, for who has them done by several processes.

#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"

namespace retrace {

/// What a task comes to, as bytes; nothing if it was cancelled. Safe to call from several threads. \throw Error
using ComputeTask = std::function<std::optional<std::string>(std::uint64_t task, const Cancellation* cancel)>;

/// Which tasks are to be done, and what became of them: kept by one process alone. Calls come one at a time.
class TaskLedger {
 public:
  virtual ~TaskLedger() = default;
  /// A task to be done next, which is then taken; nothing if none is to be had at present.
  virtual std::optional<std::uint64_t> take() = 0;
  /// A task that was taken is to be had again.
  virtual void give_back(std::uint64_t task) = 0;
  /// What a task that was taken came to. \param bytes of ComputeTask
  virtual void finish(std::uint64_t task, const std::string& bytes) = 0;
  /// Whether all is done; where more turns out to be open, take() has it. \pre no task is taken
  virtual bool is_finished() = 0;
};

/// Has the tasks of a ledger done. \return whether all are finished: false if it was cancelled \throw Error
using ShareTasks = std::function<bool(const ComputeTask& compute, TaskLedger& ledger)>;

/// Numbers as the bytes of a task.
inline std::string bytes_of(const std::vector<double>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}
/// The way back.
inline std::vector<double> numbers_of(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  return numbers;
}

}  // namespace retrace
