#pragma once

// Progress of long work on standard error: a bar on the terminal, and one line if the work will take long.

#include <chrono>
#include <functional>
#include <mutex>
#include <string>

#include "app/command.h"
#include "core/long_run.h"
#include "core/progress.h"

namespace retrace::app {

/// Texts that a progress bar shows.
struct RunText {
  std::string doing;  ///< activity, such as "tracing"
  /// Changes of options that make the run shorter, such as "give a smaller --samples (now 1000000000)".
  Words to_shorten = {};
};

/// A progress bar on standard error. On a terminal, it shows the finished fraction and the remaining time. If the run
/// will take long (LongRun), a notice with the estimated duration and advice for a shorter run is written one time,
/// also if standard error is not a terminal. With --quiet, nothing is written. Several threads may use one bar.
class ProgressBar : public Progress {
 public:
  ProgressBar(RunText text, const CommonOptions& common);
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void at(double share) override;
  /// Shows the finished fraction, followed by a remark.
  void at(double share, const std::string& remark);
  /// Shows progress of work of unknown length.
  /// \param done text about the work that is finished
  void count(const std::string& done);
  /// Begins a group of tasks within work of unknown length.
  /// \param share fraction of the group that an earlier run has finished
  void begin_group(double share);
  /// Reports the finished fraction of the group, from which the notice estimates the duration.
  /// \param group description of the group, such as "65 designs"
  void at_group(double share, const std::string& group);

  /// Sets a function that is called after the notice about a long run. The function must not use the bar.
  /// \param action receives the estimated remaining time in seconds; empty: no function is called
  void after_notice(std::function<void(double)> action);
  /// Writes lines to standard error. The bar is removed and appears again at its next update. Control characters are
  /// escaped.
  void write_lines(const std::string& lines);

 private:
  double elapsed_s() const;
  bool is_time_to_draw(bool is_end);
  /// Writes the notice about a long run when it is due.
  /// \param work description of the work that takes long
  /// \pre mutex_ is locked
  void notice(double share, const std::string& work);
  void clear();

  std::mutex mutex_;
  std::function<void(double)> after_notice_;
  RunText text_;
  bool is_quiet_;
  bool is_terminal_;
  bool drawn_ = false;
  LongRun run_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_;
};

}  // namespace retrace::app
