#pragma once

// Every block of a turned cut against the surface: how far the edge stands off it at the block's end and half-way.

#include <optional>
#include <vector>

#include "fabrication/turning/check/cuts.h"
#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

/// A place on the border of the region, under a cut that stays off the surface and is to touch it beyond the region.
struct BorderPlace {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double edge_nm = 0.0;      ///< height of the edge over the surface there, square to it
  double touching_nm = 0.0;  ///< likewise, if the edge touched where it is to touch
  std::size_t program = 0;
  std::int32_t line = 0;
};

struct TouchFigures {
  double low_nm = 0.0;   ///< deepest that the edge goes below the surface, square to it; <= 0
  double high_nm = 0.0;  ///< farthest that it stays off where it is to touch
  /// Highest Z word at which a block would touch the surface; nothing without blocks.
  std::optional<double> highest_mm;
  std::vector<BorderPlace> border;  ///< to be judged by `check_border`
};

/// The region of a part that is judged.
InspectedRegion region_of(const PathOptions& path);

/// Stands the edge in every block, at its end, half-way and where the place that is to touch crosses the border of the
/// region. Looks for the place along its sharp arc that is lowest over the surface. A block that goes below the surface
/// within the region by more than the part's tolerance, or stays off it there, is a finding `gouge` or `excess`. Blocks
/// that follow each other make one finding. Moves down by Z alone are judged for gouges.
TouchFigures check_touch(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

/// Judges the border of the region under blocks that are to touch beyond it and do not. The material that all cuts
/// together leave there may exceed what the block would leave if it touched by the tolerance; more is a finding
/// `excess`.
void check_border(const TurnedPart& part, const TurningCuts& cuts, const Envelope& envelope, TouchFigures& figures,
                  FindingList& findings);

}  // namespace retrace::fabrication::turning
