#pragma once

// Limits the computing time of an answer.

#include <chrono>

#include "core/progress.h"

namespace retrace::live {

/// Cancels a computation after a time limit, at its next report of progress.
class TimeLimit : public Progress {
 public:
  explicit TimeLimit(double seconds)
      : end_(std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds)) {}

  void at(double) override {
    if (is_over()) cancel_.request();
  }
  bool is_over() const { return std::chrono::steady_clock::now() >= end_; }
  const Cancellation* cancel() const { return &cancel_; }

 private:
  std::chrono::time_point<std::chrono::steady_clock, std::chrono::duration<double>> end_;
  Cancellation cancel_;
};

}  // namespace retrace::live
