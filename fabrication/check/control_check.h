#pragma once

// What every process asks of a program, whatever it cuts: modal settings, spindle, feeds, and axes within their limits.

#include "fabrication/check/findings.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// How the spindle is to turn while the tool cuts.
struct SpindleRule {
  NcSpindle turns = NcSpindle::stopped;
  double rpm = 0.0;  ///< of one that a program's words start; a text that starts it says nothing of speed

  bool is_by_text() const { return turns == NcSpindle::started_by_text; }
};

/// Follows programs and adds what it finds to a list.
class ControlCheck {
 public:
  ControlCheck(FindingList& findings, const SpindleRule& spindle) : findings_(findings), spindle_(spindle) {}

  /// A program begins.
  void begin();
  /// Settings that a program must make itself, looked at once, when the tool first cuts.
  void settings(const NcSettings& settings, const NcPlace& place);
  /// Of a spindle that turns, at every cutting move; the first fault of a program stands for all that follow.
  void spindle(const NcSettings& settings, const NcPlace& place);
  void spindle_at_end(const NcEnd& end);
  /// That the machine has the axes that move, and that they stay within their limits.
  void axes(const Machine& machine, const NcMotion& motion);
  /// Of a cutting move. \param most_mm_per_min that the process allows; 0: only that there is one
  void feed(const NcMotion& motion, double most_mm_per_min);

 private:
  void find_spindle(std::int32_t line, const std::string& message, double rpm);

  FindingList& findings_;
  SpindleRule spindle_;
  bool settings_are_checked_ = false;
  bool has_spindle_fault_ = false;
};

}  // namespace retrace::fabrication
