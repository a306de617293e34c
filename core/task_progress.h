#pragma once

// Progress of work that consists of several parts or of several tasks that run in parallel.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>

#include "core/progress.h"

namespace retrace {

/// Reports the progress of one part of the work as progress of the whole work. The start and the end of the part
/// correspond to the fractions `from` and `to` of the whole work.
class PartOfProgress : public Progress {
 public:
  /// \param whole receives the reports; null: nothing is reported
  PartOfProgress(Progress* whole, double from, double to) : whole_(whole), from_(from), to_(to) {}
  void at(double share) override {
    if (whole_ != nullptr) whole_->at(std::lerp(from_, to_, share));
  }

 private:
  Progress* whole_;
  double from_, to_;
};

/// Progress of work that may be abandoned and started again with another method. The progress of the new attempt is
/// mapped to the fraction that the earlier attempt left unfinished, so that reported values do not decrease.
class AttemptProgress : public Progress {
 public:
  /// \param whole receives the reports; null: nothing is reported
  explicit AttemptProgress(Progress* whole) : whole_(whole) {}
  void at(double share) override {
    reported_ = std::lerp(begin_, 1.0, share);
    if (whole_ != nullptr) whole_->at(reported_);
  }
  void begin_again() { begin_ = reported_; }

 private:
  Progress* whole_;
  double begin_ = 0.0;     ///< reported value at the start of the current attempt
  double reported_ = 0.0;  ///< last reported value
};

/// Progress of several tasks of equal weight. The mean of their progress is reported as progress of the whole work.
/// Tasks may run in parallel. Reported values do not decrease, even if a task is repeated.
class TaskProgress {
 public:
  /// \param whole receives the reports; null: nothing is reported
  /// \param count number of tasks, > 0
  TaskProgress(Progress* whole, std::size_t count) : whole_(whole), count_(static_cast<double>(count)) {}

  /// Progress of one task. If the object is destroyed before finish(), the task is regarded as not started.
  class Task : public Progress {
   public:
    explicit Task(TaskProgress& all) : all_(all) {}
    ~Task() override {
      if (!is_finished_) all_.change(-share_, 0.0);
    }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

    void at(double share) override {
      if (is_finished_ || !(share > share_)) return;
      all_.change(share - share_, 0.0);
      share_ = share;
    }
    void finish() {
      if (!is_finished_) all_.change(-share_, 1.0);
      is_finished_ = true;
    }

   private:
    TaskProgress& all_;
    double share_ = 0.0;
    bool is_finished_ = false;
  };

 private:
  /// \param running change of the sum of the progress of unfinished tasks
  /// \param finished number of tasks that have just finished
  void change(double running, double finished) {
    const std::lock_guard lock(mutex_);
    finished_ += finished;
    running_ = finished_ < count_ ? std::max(0.0, running_ + running) : 0.0;
    const double share = std::min(1.0, (finished_ + running_) / count_);
    if (whole_ == nullptr || !(share > reported_)) return;
    reported_ = share;
    whole_->at(share);
  }

  Progress* whole_;
  double count_;
  double finished_ = 0.0;
  double running_ = 0.0;   ///< sum of the progress of unfinished tasks
  double reported_ = 0.0;  ///< last reported value
  std::mutex mutex_;
};

}  // namespace retrace
