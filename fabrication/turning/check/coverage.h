#pragma once

// Whether the cuts of a turned part lie beside each other as they should: turn by turn or line by line, over the whole
// region.

#include "fabrication/turning/check/cuts.h"

namespace retrace::fabrication::turning {

struct CoverageFigures {
  double step_mm_max = 0.0;  ///< from a cut to the one before it
  bool is_orderly = true;    ///< every cut goes on in its direction, so that what is left can be found
  bool is_whole = true;      ///< no place of the region lies farther than a feed from a cut
};

/// Finds blocks that do not go on (`direction`), cuts that lie farther than the feed from the one before them
/// (`feed_step`) or off the tool's skew (`skew`), and parts of the region that no cut reaches (`uncut`).
CoverageFigures check_coverage(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

}  // namespace retrace::fabrication::turning
