#include "app/first_answer.h"

#include <system_error>
#include <utility>

namespace retrace::app {

FirstAnswer::FirstAnswer(ProgressBar& bar, const Cancellation* cancel, Compute compute)
    : bar_(bar), cancel_(cancel), compute_(std::move(compute)) {
  if (bar_.is_quiet()) return;
  bar_.after_notice([this](double) {
    const std::lock_guard lock(mutex_);
    is_long_ = true;
    changed_.notify_one();
  });
  try {
    thread_ = std::thread([this] { wait_and_compute(); });
  } catch (const std::system_error&) {
    // The system cannot start another thread. Preliminary results are omitted.
  }
}

FirstAnswer::~FirstAnswer() {
  bar_.after_notice({});
  cancel_.request();
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    changed_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

/// Waits until the progress bar reports a long computation, but at most for kPatience. Returns true if preliminary
/// results should then be computed. Returns false if this object is being destroyed.
bool FirstAnswer::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPatience, [this] { return is_long_ || is_over_; });
  return !is_over_;
}

void FirstAnswer::wait_and_compute() try {
  if (!wait()) return;
  const std::optional<double> remaining_s = bar_.remaining_s();
  if (remaining_s && *remaining_s < kSoonS) return;
  const std::string lines = compute_(remaining_s, &cancel_);
  if (!cancel_.requested()) bar_.write_lines(lines);
} catch (...) {  // NOLINT(bugprone-empty-catch): after an error, no preliminary results are written
}

}  // namespace retrace::app
