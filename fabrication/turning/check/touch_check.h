#pragma once

// Every block of a turned cut against the surface: how far the edge stands off it at the block's end and half-way.

#include <optional>
#include <vector>

#include "fabrication/turning/check/cuts.h"
#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

/// A point on the border of the region, below the path of one block of the program. The block should touch the surface
/// outside of the region, and the edge does not reach the surface inside the region.
struct BorderPlace {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double edge_nm = 0.0;      ///< height of the edge above the surface at this point, normal to the surface
  double touching_nm = 0.0;  ///< the same height if the edge reached the surface at its intended point of contact
  std::size_t program = 0;
  std::int32_t line = 0;
};

struct TouchFigures {
  double low_nm = 0.0;   ///< deepest that the edge goes below the surface, square to it; <= 0
  double high_nm = 0.0;  ///< farthest that it stays off where it is to touch
  /// Highest Z word at which a block would touch the surface; nothing without blocks.
  std::optional<double> highest_mm;
  std::vector<BorderPlace> border;  ///< input for check_border()
};

/// The region of a part that is judged.
InspectedRegion region_of(const PathOptions& path);

/// Computes the distance between the cutting edge and the surface for every block: at its end, half-way, and where the
/// point of contact crosses the border of the region. The point of contact is the point of the edge that is closest to
/// the surface. If the edge is below the surface inside the region by more than the part's tolerance, the finding is
/// `gouge`. If it is above the surface by more than the tolerance, the finding is `excess`. Consecutive blocks give one
/// finding. Moves of only Z downwards are checked only for `gouge`.
TouchFigures check_touch(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

/// Checks the material at the border of the region below blocks whose intended point of contact is outside of the
/// region and that do not reach the surface. The height of the material that all cuts leave is compared with the height
/// that the block would leave with contact. If the difference is larger than the tolerance, the finding is `excess`.
void check_border(const TurnedPart& part, const TurningCuts& cuts, const Envelope& envelope, TouchFigures& figures,
                  FindingList& findings);

}  // namespace retrace::fabrication::turning
