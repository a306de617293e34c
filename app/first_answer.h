#pragma once

// Computes preliminary results in parallel with a long computation.

#include <functional>
#include <string>
#include <thread>

#include "app/progress_bar.h"
#include "core/progress.h"

namespace retrace::app {

/// Computes preliminary results in a separate thread and writes them to standard error. The thread starts after the
/// progress bar has reported that the main computation will take long. It stops when the main computation is
/// interrupted or this object is destroyed. If the preliminary computation fails, nothing is written.
class FirstAnswer {
 public:
  /// Function that returns the lines to write, or an empty text to write nothing. It runs in parallel with the main
  /// computation.
  /// \param remaining_s estimated remaining time of the main computation, in seconds
  /// \param cancel request to stop; the function must check it regularly
  using Compute = std::function<std::string(double remaining_s, const Cancellation* cancel)>;

  /// \param bar progress bar of the main computation; it must outlive this object
  /// \param cancel request to stop the main computation
  FirstAnswer(ProgressBar& bar, const Cancellation* cancel, Compute compute);
  /// Stops the preliminary computation and waits for its thread.
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
