#pragma once

// Shows the progress of a computation on standard error: a bar on a terminal, and one line of text if the computation
// will take long.

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "app/command.h"
#include "core/long_run.h"
#include "core/progress.h"

namespace retrace::app {

/// Texts of a progress bar.
struct RunText {
  std::string doing;  ///< activity, such as "tracing"
  /// Advice for a shorter run, such as "give a smaller --samples (now 1000000000)".
  Words to_shorten = {};
};

/// Progress bar on standard error. On a terminal, it shows the finished fraction and the remaining time. If the run
/// will take long (see LongRun), it writes one notice with the estimated duration and advice for a shorter run. The
/// notice is also written if standard error is not a terminal. With --quiet, nothing is written. The class is
/// thread-safe.
class ProgressBar : public Progress {
 public:
  ProgressBar(RunText text, const CommonOptions& common);
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void at(double fraction) override;
  /// Shows the finished fraction, followed by the text `remark`.
  void at(double fraction, const std::string& remark);
  /// Shows the progress of a computation of unknown length, for which the fraction is unknown.
  /// \param done text about the finished work, such as "65 designs evaluated"
  void count(const std::string& done);
  /// Starts a group of tasks within a computation of unknown length. The number of tasks in the group is known.
  /// \param fraction fraction of the group that was finished in an earlier run
  void begin_group(double fraction);
  /// Reports the finished fraction of the group. The notice about a long run is based on this fraction.
  /// \param group description of the group for the notice, such as "computing the next 65 designs"
  void at_group(double fraction, const std::string& group);

  bool is_quiet() const { return is_quiet_; }
  /// Returns the latest estimate of at() for the remaining time, in seconds. Returns nothing before the first estimate.
  std::optional<double> remaining_s();
  /// Sets a function that is called after the notice about a long run. The function must not use the bar, because the
  /// mutex of the bar is locked during the call.
  /// \param action function with the estimated remaining time in seconds as its parameter. If it is empty, nothing is
  /// called.
  void after_notice(std::function<void(double)> action);
  /// Writes lines to standard error. Removes the bar first; the next update draws it again. Control characters are
  /// printed as escapes.
  void write_lines(const std::string& lines);

 private:
  double elapsed_s() const;
  bool is_time_to_draw(bool is_end);
  /// Writes the notice about a long run if LongRun::notice_s() requests it.
  /// \param work description of the computation that takes long, such as "this run"
  /// \pre mutex_ is locked
  void notice(double fraction, const std::string& work);
  void clear();

  std::mutex mutex_;
  std::function<void(double)> after_notice_;
  RunText text_;
  bool is_quiet_;
  bool is_terminal_;
  bool drawn_ = false;
  LongRun run_;
  std::optional<double> remaining_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_;
};

}  // namespace retrace::app
