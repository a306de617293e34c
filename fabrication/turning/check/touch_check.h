#pragma once

// Every block of a turned cut against the surface: how far the edge stands off it at the block's end and half-way.

#include <optional>
#include <vector>

#include "fabrication/turning/check/cuts.h"
#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

/// A point at the border of the region, below the path of a block whose planned point of contact is outside of the
/// region. Inside the region, the edge does not reach the surface at this pose.
struct BorderPlace {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double edge_nm = 0.0;  ///< height of the edge above the surface at this point, along the surface normal
  /// The height that the edge would have here if it touched the surface at its planned point of contact.
  double touching_nm = 0.0;
  std::size_t program = 0;
  std::int32_t line = 0;
};

struct TouchFigures {
  double low_nm = 0.0;   ///< deepest that the edge goes below the surface, square to it; <= 0
  double high_nm = 0.0;  ///< farthest that it stays off where it is to touch
  /// Highest Z word at which a block would touch the surface; nothing without blocks.
  std::optional<double> highest_mm;
  std::vector<BorderPlace> border;  ///< points that check_border() evaluates
};

/// The region of a part that is judged.
InspectedRegion region_of(const PathOptions& path);

/// Computes the distance between cutting edge and surface for every block: at its end, at half its length, and where
/// the point of contact crosses the border of the region. The point of contact is the point of the edge that is closest
/// to the surface. Adds a finding `gouge` if the edge is below the surface inside the region by more than the part's
/// tolerance, and `excess` if it is above the surface by more than the tolerance. Consecutive blocks give one finding.
/// Blocks that only lower Z are checked only for `gouge`.
TouchFigures check_touch(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

/// Checks the remaining material at the border of the region below TouchFigures::border. These blocks have their
/// planned point of contact outside of the region and do not reach the surface. The height of the material after all
/// cuts is compared with the height after a cut that touches the surface. Adds a finding `excess` if the difference is
/// larger than the tolerance.
void check_border(const TurnedPart& part, const TurningCuts& cuts, const Envelope& envelope, TouchFigures& figures,
                  FindingList& findings);

}  // namespace retrace::fabrication::turning
