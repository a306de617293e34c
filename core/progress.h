#pragma once

// Interfaces between long work and its caller: a request to stop, and reports of the share that is done.

#include <atomic>

#include "api.h"  // of this folder: these headers are installed with the library

namespace retrace {

/// Asked between pieces of work whether to stop. Safe to set from a signal handler.
class Cancellation {
 public:
  Cancellation() = default;
  /// \param whole if its stop is requested, this work stops as well; null: there is none. It must outlive this object.
  explicit Cancellation(const Cancellation* whole) : whole_(whole) {}
  void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
  bool requested() const noexcept {
    return requested_.load(std::memory_order_relaxed) || (whole_ != nullptr && whole_->requested());
  }

 private:
  const Cancellation* whole_ = nullptr;
  std::atomic<bool> requested_{false};
};

/// Whether work was asked to stop. \param cancel null: it cannot be stopped
inline bool is_cancelled(const Cancellation* cancel) {
  return cancel != nullptr && cancel->requested();
}

/// Told how far long work has come. Calls come from one thread at a time.
class RETRACE_API Progress {
 public:
  virtual ~Progress() = default;
  /// `share` in 0..1, never falling.
  virtual void at(double share) = 0;
};

}  // namespace retrace
