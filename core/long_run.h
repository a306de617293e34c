#pragma once

// Estimates the remaining time of a computation from its progress. Decides when the user should be informed that the
// computation will take long.

#include <optional>
#include <string>

namespace retrace {

/// Remaining time of a computation, extrapolated linearly from its progress. The caller measures the elapsed time.
class LongRun {
 public:
  /// Minimum time in seconds from the start of the current part until notice_s() may inform the user.
  static constexpr double kFirstEstimateS = 1.0;
  /// Remaining time in seconds above which notice_s() informs the user.
  static constexpr double kLongS = 60.0;

  /// Returns the estimated remaining time in seconds, or nothing before any progress. Work that was finished before the
  /// first call, for example by an earlier run, does not count as progress.
  /// \param fraction fraction of the work that is finished, 0 to 1
  /// \param elapsed_s time since the start of the work, in seconds
  std::optional<double> remaining_s(double fraction, double elapsed_s);

  /// Returns the estimated remaining time in seconds if the user should now be informed of it. Otherwise returns
  /// nothing. The user is informed at most one time: after that, every call returns nothing.
  /// \param fraction fraction of the work that is finished, 0 to 1
  /// \param elapsed_s time since the start of the work, in seconds
  std::optional<double> notice_s(double fraction, double elapsed_s);

  /// Starts a new part of the work. In later calls, `fraction` is the finished fraction of this part only.
  /// \param fraction fraction of the part that is already finished
  /// \param elapsed_s time since the start of the work, in seconds
  void begin_part(double fraction, double elapsed_s);

 private:
  std::optional<double> first_fraction_;
  double begun_s_ = 0.0;  ///< elapsed time at the start of the current part, in seconds
  bool is_user_informed_ = false;
};

/// Returns a duration as rounded text, such as "90 s", "12 min", "2.8 h" or "11.6 days".
std::string duration_text(double seconds);

}  // namespace retrace
