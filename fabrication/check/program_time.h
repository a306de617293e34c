#pragma once

// How long a program takes, from the moves that were read.

#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Seconds by what they are spent on. Moves start and end at rest, but for those that say their time.
struct ProgramTime {
  double feed_s = 0.0;
  double rapid_s = 0.0;
  double rotary_s = 0.0;
  double dwell_s = 0.0;
  double total_s() const { return feed_s + rapid_s + rotary_s + dwell_s; }
  ProgramTime operator-(const ProgramTime& other) const {
    return {feed_s - other.feed_s, rapid_s - other.rapid_s, rotary_s - other.rotary_s, dwell_s - other.dwell_s};
  }

  /// Adds the time of a move of all its axes (motion_time.h). If the program gives the time of the move, this time is
  /// added. A rapid move counts as rotary if its rotary axes alone take longer than its linear axes alone. A linear
  /// axis whose position is not yet known adds no time. Rotary axes start at 0.
  void add(const Machine& machine, const NcMotion& motion);
};

}  // namespace retrace::fabrication
