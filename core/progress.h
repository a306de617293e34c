#pragma once

// Interfaces between long work and its caller: a request to stop, and reports of the share that is done.

#include <atomic>

#include "api.h"  // of this folder: these headers are installed with the library

namespace retrace {

/// A request to stop, which work checks at regular intervals. It may be set from a signal handler.
class Cancellation {
 public:
  Cancellation() = default;
  /// \param whole request to stop a larger piece of work that includes this one; null: there is none. It must outlive
  ///        this object.
  explicit Cancellation(const Cancellation* whole) : whole_(whole) {}
  void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
  bool requested() const noexcept {
    return requested_.load(std::memory_order_relaxed) || (whole_ != nullptr && whole_->requested());
  }

 private:
  const Cancellation* whole_ = nullptr;
  std::atomic<bool> requested_{false};
};

/// Returns true if the work is requested to stop.
/// \param cancel null: the work cannot be stopped
inline bool is_cancelled(const Cancellation* cancel) {
  return cancel != nullptr && cancel->requested();
}

/// Receives reports of progress. Only one thread calls it at a time.
class RETRACE_API Progress {
 public:
  virtual ~Progress() = default;
  /// Reports the finished fraction of the work.
  /// \param share 0 to 1, never smaller than in an earlier call
  virtual void at(double share) = 0;
};

}  // namespace retrace
