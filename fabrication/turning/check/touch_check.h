#pragma once

// Every block of a turned cut against the surface: how far the edge stands off it at the block's end and half-way.

#include "fabrication/turning/check/cuts.h"
#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

struct TouchFigures {
  double low_nm = 0.0;   ///< deepest that the edge goes below the surface, square to it; <= 0
  double high_nm = 0.0;  ///< farthest that it stays off where it is to touch
  /// Highest Z word at which a block would touch the surface; nothing without blocks.
  std::optional<double> highest_mm;
};

/// The region of a part that is judged.
InspectedRegion region_of(const PathOptions& path);

/// Stands the edge in every block, at its end and half-way, and looks for the place along its sharp arc that is lowest
/// over the surface. Of a block that goes below the surface within the region, or stays off it there, by more than the
/// part's tolerance is a finding `gouge` or `excess`, one for blocks that follow each other; likewise where the tool
/// comes down by Z alone.
TouchFigures check_touch(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

}  // namespace retrace::fabrication::turning
