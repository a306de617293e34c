#pragma once

// Preliminary results, computed next to work that takes long.

#include <functional>
#include <string>
#include <thread>

#include "app/progress_bar.h"
#include "core/progress.h"

namespace retrace::app {

/// Computes preliminary results on a thread of its own and writes them to standard error. The thread starts when the
/// progress bar has reported that the main work will take long. It stops when the main work is interrupted, or when
/// this object is destroyed. If the computation fails, nothing is written, because the main work reports its own
/// errors.
class FirstAnswer {
 public:
  /// Returns the lines to write; empty: nothing is written. It runs at the same time as the main work.
  /// \param remaining_s estimated remaining time of the main work \param cancel asked whether to stop
  using Compute = std::function<std::string(double remaining_s, const Cancellation* cancel)>;

  /// \param bar bar of the main work; it must outlive this object \param cancel request to stop the main work
  FirstAnswer(ProgressBar& bar, const Cancellation* cancel, Compute compute);
  /// Stops the computation and waits for its end.
  ~FirstAnswer();
  FirstAnswer(const FirstAnswer&) = delete;
  FirstAnswer& operator=(const FirstAnswer&) = delete;

 private:
  void begin(double remaining_s);

  ProgressBar& bar_;
  Cancellation cancel_;
  Compute compute_;
  std::thread thread_;
};

}  // namespace retrace::app
