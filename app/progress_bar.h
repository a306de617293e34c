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

/// What a progress bar shows of a run.
struct RunText {
  std::string doing;  ///< such as "tracing"
  /// Alternatives that make the run shorter, such as "give a smaller --samples (now 1000000000)".
  Words to_shorten = {};
};

/// A bar on standard error with the finished fraction and the remaining time, if standard error is a terminal. One time
/// in a run, a line reports the estimated duration and what makes the run shorter, see LongRun. This line is also
/// written if standard error is not a terminal. With --quiet, nothing is written. Several threads may use a bar.
class ProgressBar : public Progress {
 public:
  ProgressBar(RunText text, const CommonOptions& common);
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void at(double share) override;
  /// Shows the fraction with a remark behind it.
  void at(double share, const std::string& remark);
  /// Shows work whose end is not known. \param done what has been done so far
  void count(const std::string& done);
  /// Begins a group of tasks of work whose end is not known. \param share fraction of the group that is finished
  /// already
  void begin_group(double share);
  /// Reports the finished fraction of the group, for the line about long work. \param group such as "65 designs"
  void at_group(double share, const std::string& group);

  /// Sets the function that is called after the line about long work was written. It must not use the bar.
  /// \param action receives the estimated remaining time in seconds; empty: nothing is called
  void after_notice(std::function<void(double)> action);
  /// Writes lines on standard error and removes the bar until it is drawn again. Control characters are escaped.
  void write_lines(const std::string& lines);

 private:
  double elapsed_s() const;
  bool is_time_to_draw(bool is_end);
  /// Writes the line about long work if it is time for it. \param work what takes the time \pre mutex_ is locked
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
