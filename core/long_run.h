#pragma once

// Estimates the remaining time of work from its progress, and decides when the user should be informed that the work
// will take long.

#include <optional>
#include <string>

namespace retrace {

/// Remaining time of work, extrapolated from its progress. The caller measures the time, so the class needs no clock.
class LongRun {
 public:
  /// Elapsed time in seconds from which on the remaining time is estimated.
  static constexpr double kFirstEstimateS = 1.0;
  /// Remaining time in seconds above which work takes long.
  static constexpr double kLongS = 60.0;

  /// Returns the estimated remaining time in seconds, or nothing before any progress. Work that was finished before the
  /// first call, for example by an earlier run, does not count as progress.
  /// \param share fraction of the work that is finished, 0 to 1 \param elapsed_s time since the work began
  std::optional<double> remaining_s(double share, double elapsed_s);

  /// Returns the estimated remaining time in seconds if the user should now be informed of it, and nothing otherwise.
  /// It is returned at most one time in the life of this object.
  /// \param share, elapsed_s as those of remaining_s()
  std::optional<double> notice_s(double share, double elapsed_s);

  /// Starts a new part of the work, to which later fractions refer.
  /// \param share finished fraction of the part \param elapsed_s time since the work began
  void begin_part(double share, double elapsed_s);

 private:
  std::optional<double> first_share_;
  double begun_s_ = 0.0;  ///< elapsed time at which the current part began
  bool is_noticed_ = false;
};

/// Returns a duration as rounded text, such as "90 s", "12 min", "2.8 h" or "11.6 days".
std::string duration_text(double seconds);

}  // namespace retrace
