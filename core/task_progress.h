#pragma once

// Combines the progress of parts, repeated attempts or parallel tasks into the progress of the whole computation.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>

#include "core/progress.h"

namespace retrace {

/// Reports the progress of one part of a computation as progress of the whole computation. The progress of the part, 0
/// to 1, is mapped linearly to the range from `from` to `to`.
class PartProgress : public Progress {
 public:
  /// \param whole receiver of the progress of the whole computation; if null, nothing is reported
  PartProgress(Progress* whole, double from, double to) : parent_(whole), from_(from), to_(to) {}
  void at(double fraction) override {
    if (parent_ != nullptr) parent_->at(std::lerp(from_, to_, fraction));
  }

 private:
  Progress* parent_;
  double from_, to_;
};

/// Progress of a computation that may be aborted and started again with another method. The progress of the new
/// attempt, 0 to 1, is mapped to the range from the last reported value to 1, so that reported values do not decrease.
class AttemptProgress : public Progress {
 public:
  /// \param whole receiver of the reported values; if null, nothing is reported
  explicit AttemptProgress(Progress* whole) : parent_(whole) {}
  void at(double fraction) override {
    reported_ = std::lerp(begin_, 1.0, fraction);
    if (parent_ != nullptr) parent_->at(reported_);
  }
  void begin_again() { begin_ = reported_; }

 private:
  Progress* parent_;
  double begin_ = 0.0;     ///< reported value at the start of the current attempt
  double reported_ = 0.0;  ///< last reported value
};

/// Progress of several tasks of equal weight, which may run in parallel. The mean of the progress of all tasks is
/// reported. Reported values do not decrease, even if a task is repeated.
class TaskProgress {
 public:
  /// \param whole receiver of the mean progress; if null, nothing is reported
  /// \param count number of tasks, > 0
  TaskProgress(Progress* whole, std::size_t count) : parent_(whole), count_(static_cast<double>(count)) {}

  /// Progress of one task. If the object is destroyed without a call of finish(), the task counts as not started.
  class Task : public Progress {
   public:
    explicit Task(TaskProgress& all) : all_(all) {}
    ~Task() override {
      if (!is_finished_) all_.change(-fraction_, 0.0);
    }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

    void at(double fraction) override {
      if (is_finished_ || !(fraction > fraction_)) return;
      all_.change(fraction - fraction_, 0.0);
      fraction_ = fraction;
    }
    void finish() {
      if (!is_finished_) all_.change(-fraction_, 1.0);
      is_finished_ = true;
    }

   private:
    TaskProgress& all_;
    double fraction_ = 0.0;
    bool is_finished_ = false;
  };

 private:
  /// Updates the sums and reports the mean progress if it has increased.
  /// \param running amount by which the total progress of unfinished tasks changes
  /// \param finished number of tasks that have finished since the last call
  void change(double running, double finished) {
    const std::lock_guard lock(mutex_);
    finished_ += finished;
    running_ = finished_ < count_ ? std::max(0.0, running_ + running) : 0.0;
    const double share = std::min(1.0, (finished_ + running_) / count_);
    if (parent_ == nullptr || !(share > reported_)) return;
    reported_ = share;
    parent_->at(share);
  }

  Progress* parent_;
  double count_;
  double finished_ = 0.0;
  double running_ = 0.0;   ///< total progress of unfinished tasks, each from 0 to 1
  double reported_ = 0.0;  ///< last reported value
  std::mutex mutex_;
};

}  // namespace retrace
