#pragma once

// What the axes of a lathe do along cuts, from their positions and times alone, against the machine's limits.

#include <array>

#include "fabrication/turning/check/cuts.h"

namespace retrace::fabrication::turning {

/// What an axis does over cuts, less what the rounding of the words to nanometres alone may make of it.
struct AxisMotion {
  double low_mm = 0.0;
  double high_mm = 0.0;
  double speed_mm_per_s = 0.0;
  double acceleration_mm_per_s2 = 0.0;  ///< from block to block
  double jerk_mm_per_s3 = 0.0;
};

struct MotionFigures {
  std::array<AxisMotion, 4> axes;  ///< X, Y, the slide's Z, servo; travel with the moves between cuts
  double spindle_rpm = 0.0;
  double c_acceleration_deg_per_s2 = 0.0;  ///< ends of cuts included, where C stands still
  double blocks_per_s = 0.0;
  double time_s = 0.0;  ///< of cuts
};

/// Speed, acceleration and jerk of X, Y, Z and a servo between blocks and within moves by cubics, whose acceleration
/// may have steps where they meet, so that jerk is that from block to block; and of C, whose acceleration is that from
/// a standstill and back as well where the machine limits it; C's speed and the speed along the lines of a raster
/// against the path's; blocks in a second. Adds the worst of every kind, axis and program.
MotionFigures check_motion(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

}  // namespace retrace::fabrication::turning
