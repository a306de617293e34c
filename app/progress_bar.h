#pragma once

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

 private:
  std::string what_;
  bool enabled_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_;
};

}  // namespace retrace::app
