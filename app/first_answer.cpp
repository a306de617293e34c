#include "app/first_answer.h"

#include <system_error>
#include <utility>

namespace retrace::app {

FirstAnswer::FirstAnswer(ProgressBar& bar, const Cancellation* cancel, Compute compute)
    : bar_(bar), cancel_(cancel), compute_(std::move(compute)) {
  bar_.after_notice([this](double remaining_s) { begin(remaining_s); });
}

FirstAnswer::~FirstAnswer() {
  bar_.after_notice({});
  cancel_.request();
  if (thread_.joinable()) thread_.join();
}

void FirstAnswer::begin(double remaining_s) try {
  thread_ = std::thread([this, remaining_s] {
    try {
      const std::string lines = compute_(remaining_s, &cancel_);
      if (!cancel_.requested()) bar_.write_lines(lines);
    } catch (...) {  // NOLINT(bugprone-empty-catch): preliminary results are omitted
    }
  });
} catch (const std::system_error&) {
  // The system cannot start another thread. Preliminary results are omitted.
}

}  // namespace retrace::app
