#pragma once

// Computes preliminary results in parallel with a long computation.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/progress_bar.h"
#include "core/progress.h"

namespace retrace::app {

/// Computes preliminary results in a separate thread and writes them to standard error. The computation starts when the
/// progress bar reports that the main computation will take long, and at the latest after kPatience. It stops when the
/// main computation is interrupted or this object is destroyed. If it fails, nothing is written. With --quiet, nothing
/// is computed.
class FirstAnswer {
 public:
  /// Time after which preliminary results are computed even if the progress bar has not reported a long computation.
  static constexpr std::chrono::seconds kPatience{4};
  /// Minimum remaining time of the main computation, in seconds. If the estimated remaining time is shorter, no
  /// preliminary results are computed.
  static constexpr double kSoonS = 6.0;
  /// Function that returns the lines to write, or an empty text to write nothing. It runs in parallel with the main
  /// computation.
  /// \param remaining_s estimated remaining time of the main computation, in seconds; empty if it is unknown
  /// \param cancel request to stop; the function must check it regularly
  using Compute = std::function<std::string(std::optional<double> remaining_s, const Cancellation* cancel)>;

  /// \param bar progress bar of the main computation; it must outlive this object
  /// \param cancel request to stop the main computation
  FirstAnswer(ProgressBar& bar, const Cancellation* cancel, Compute compute);
  /// Stops the preliminary computation and waits for its thread.
  ~FirstAnswer();
  FirstAnswer(const FirstAnswer&) = delete;
  FirstAnswer& operator=(const FirstAnswer&) = delete;

 private:
  void wait_and_compute();
  bool wait();

  ProgressBar& bar_;
  Cancellation cancel_;
  Compute compute_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_long_ = false;  ///< true after the progress bar has reported that the main computation takes long
  bool is_over_ = false;  ///< true after the destructor of this object has started
  std::thread thread_;
};

}  // namespace retrace::app
