#pragma once

// Determines which of the processes that share a store are still alive. Each process holds a file lock for this
// purpose.

#include <cstdint>
#include <filesystem>

namespace retrace::compute {

/// Locks that show which processes are alive. Each process locks one byte of a common file. The system releases the
/// lock when the process ends for any reason.
class ProcessLocks {
 public:
  /// Locks the first free byte.
  /// \throw OutputError if the file cannot be created or locked
  explicit ProcessLocks(const std::filesystem::path& file);
  ~ProcessLocks();
  ProcessLocks(const ProcessLocks&) = delete;
  ProcessLocks& operator=(const ProcessLocks&) = delete;

  /// Returns the index of the byte that this process has locked. After the death of a process, another process may lock
  /// its byte.
  std::int64_t own() const { return own_; }
  bool is_alive(std::int64_t owner) const;

 private:
  int descriptor_ = -1;
  std::int64_t own_ = 0;
};

}  // namespace retrace::compute
