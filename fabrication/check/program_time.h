#pragma once

// Computes the run time of an NC program from its moves.

#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Run time in seconds, divided by kind of motion. Moves start and end at rest, except for moves whose duration the
/// program specifies.
struct ProgramTime {
  double feed_s = 0.0, rapid_s = 0.0, rotary_s = 0.0, dwell_s = 0.0;
  double total_s() const { return feed_s + rapid_s + rotary_s + dwell_s; }
  ProgramTime operator-(const ProgramTime& other) const {
    return {feed_s - other.feed_s, rapid_s - other.rapid_s, rotary_s - other.rotary_s, dwell_s - other.dwell_s};
  }

  /// Adds the time of one move, computed from the travel of all its axes (motion_time.h). If the program specifies the
  /// duration of the move, that duration is added instead. A rapid move counts as rotary if its rotary axes need more
  /// time than its linear axes. A linear axis whose position is not yet known adds no time. Rotary axes start at 0.
  void add(const Machine& machine, const NcMotion& motion);
};

}  // namespace retrace::fabrication
