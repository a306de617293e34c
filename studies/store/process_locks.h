#pragma once

// Tells which of several processes that share a store are still alive, by file locks.

#include <cstdint>
#include <filesystem>

namespace retrace::studies {

/// Which processes live, told by the locks that each holds on one byte of a common file: the system lets go of them
/// when a process ends, however it ends.
class ProcessLocks {
 public:
  /// Takes the first free byte. \throw OutputError if the file cannot be made or locked
  explicit ProcessLocks(const std::filesystem::path& file);
  ~ProcessLocks();
  ProcessLocks(const ProcessLocks&) = delete;
  ProcessLocks& operator=(const ProcessLocks&) = delete;

  /// The byte of this process. That of a process that died may be taken by another.
  std::int64_t own() const { return own_; }
  bool is_alive(std::int64_t owner) const;

 private:
  int descriptor_ = -1;
  std::int64_t own_ = 0;
};

}  // namespace retrace::studies
