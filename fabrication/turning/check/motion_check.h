#pragma once

// Checks the speed, acceleration and jerk of a lathe's axes along cuts. These values are computed from positions and
// times.

#include <array>

#include "fabrication/turning/check/cuts.h"

namespace retrace::fabrication::turning {

/// Extreme values of the motion of an axis over the cuts. The maximum effect of rounded positions is subtracted from
/// all values.
struct AxisMotion {
  double low_mm = 0.0;
  double high_mm = 0.0;
  double speed_mm_per_s = 0.0;
  double acceleration_mm_per_s2 = 0.0;  ///< maximum acceleration between neighbouring blocks
  double jerk_mm_per_s3 = 0.0;
};

struct MotionFigures {
  std::array<AxisMotion, 4> axes;  ///< X, Y, slide Z, servo; travel includes the moves between cuts
  double spindle_rpm = 0.0;
  double c_acceleration_deg_per_s2 = 0.0;  ///< maximum acceleration of C, including start and stop of cuts
  double blocks_per_s = 0.0;
  double time_s = 0.0;  ///< total time of the cuts
};

/// Checks speed, acceleration and jerk of X, Y, Z and a servo, between blocks and in cubic moves. The acceleration of
/// cubic moves may have steps at their ends, so jerk is computed between blocks. The acceleration of C includes start
/// and stop if the machine limits it. Also checks the speed of C, the speed along the lines of a raster, and the number
/// of blocks per second. Adds the worst finding of each kind, axis and program.
MotionFigures check_motion(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

}  // namespace retrace::fabrication::turning
