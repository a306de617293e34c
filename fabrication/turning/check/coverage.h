#pragma once

// Checks that the cuts of a turned part cover the whole region, turn by turn or line by line.

#include "fabrication/turning/check/cuts.h"

namespace retrace::fabrication::turning {

struct CoverageFigures {
  double step_mm_max = 0.0;  ///< maximum distance between neighbouring cuts
  bool is_monotonic = true;  ///< true if every cut moves forward; otherwise the machined surface cannot be computed
  bool is_complete = true;   ///< true if no part of the region is left uncut
};

/// Checks the order and the distance of the cuts. The kinds of findings are:
/// - `direction`: a block does not move forward,
/// - `feed_step`: a cut is farther than the feed from the previous cut,
/// - `skew`: a cut is not on the line that the tool's skew determines,
/// - `uncut`: a part of the region has no cuts
CoverageFigures check_coverage(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

}  // namespace retrace::fabrication::turning
