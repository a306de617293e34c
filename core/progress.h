#pragma once

// Interfaces between a long computation and its caller: a request to stop, and reports of the finished fraction.

#include <atomic>

#include "api.h"  // without a folder, because these headers are installed together with the library

namespace retrace {

/// Request to stop a computation. The computation checks it at regular intervals. A signal handler may set it.
class Cancellation {
 public:
  Cancellation() = default;
  /// \param parent request to stop a larger computation that includes this one, or null; it must outlive this object
  explicit Cancellation(const Cancellation* parent) : parent_(parent) {}
  void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
  bool requested() const noexcept {
    return requested_.load(std::memory_order_relaxed) || (parent_ != nullptr && parent_->requested());
  }

 private:
  const Cancellation* parent_ = nullptr;
  std::atomic<bool> requested_{false};
};

/// Returns true if the computation is requested to stop.
/// \param cancel request to stop, or null if the computation cannot be stopped
inline bool is_cancelled(const Cancellation* cancel) {
  return cancel != nullptr && cancel->requested();
}

/// Receiver of progress reports. Only one thread calls it at a time.
class RETRACE_API Progress {
 public:
  virtual ~Progress() = default;
  /// Reports the finished fraction of the work.
  /// \param fraction 0 to 1, never smaller than in an earlier call
  virtual void at(double fraction) = 0;
};

}  // namespace retrace
