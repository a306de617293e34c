#pragma once

// Progress of long work as a bar on the terminal.

#include <chrono>
#include <string>

#include "core/progress.h"

namespace retrace::app {

/// A bar on standard error with the share done and the time left; draws nothing when that is not a terminal.
class ProgressBar : public Progress {
 public:
  /// \param enabled false draws nothing
  ProgressBar(std::string what, bool enabled);
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void at(double share) override;
  /// The same, with a remark behind it.
  void at(double share, const std::string& remark);
  /// Work whose end is not known: what has been done so far, with the time it took.
  void count(const std::string& done);

 private:
  std::string what_;
  bool enabled_;
  bool drawn_ = false;
  double first_share_ = -1.0;  ///< that work began with; negative before the first call
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_;
};

}  // namespace retrace::app
