#pragma once

// Progress of work that consists of several parts or of several tasks that run in parallel.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>

#include "core/progress.h"

namespace retrace {

/// Reports the progress of one part of the work as progress of the whole work. The values 0 and 1 of the part are
/// reported as `from` and `to`.
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

/// Progress of work that may be given up and begun again by another method. The new attempt is reported as the part of
/// the work that the attempt before has not finished.
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
  double begin_ = 0.0;     ///< value that stands for the beginning of the current attempt
  double reported_ = 0.0;  ///< last reported value
};

/// Adds up the progress of tasks of equal weight and reports the mean as progress of the whole work. Tasks may run in
/// parallel. Reports never fall, even if a task is repeated.
class TaskProgress {
 public:
  /// \param whole receives the reports; null: nothing is reported
  /// \param count number of tasks, > 0
  TaskProgress(Progress* whole, std::size_t count) : whole_(whole), count_(static_cast<double>(count)) {}

  /// Progress of one task. If it is destroyed before finish(), its progress is subtracted again, because the task is
  /// then repeated or given up.
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
  /// \param running change of the progress of unfinished tasks \param finished number of tasks that have finished
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
