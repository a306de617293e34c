#pragma once

// Checks the distance between cutting edge and surface for every block of a turned part.

#include <optional>
#include <vector>

#include "fabrication/turning/check/cuts.h"
#include "fabrication/turning/check/inspection.h"

namespace retrace::fabrication::turning {

/// Point at the border of the inspected region at which the edge is above the surface. The planned point of contact of
/// its block is outside of the region.
struct BorderPoint {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double edge_nm = 0.0;  ///< height of the edge above the surface at this point, along the surface normal
  /// Height of the edge above the surface at this point for a cut that touches the surface at its point of contact.
  double touching_nm = 0.0;
  std::size_t program = 0;
  std::int32_t line = 0;
};

struct ContactFigures {
  double low_nm = 0.0;   ///< lowest height of the edge relative to the surface, along the surface normal; <= 0
  double high_nm = 0.0;  ///< largest distance of the edge above the surface
  /// Highest Z position at which a block would touch the surface; empty if there are no blocks.
  std::optional<double> highest_mm;
  std::vector<BorderPoint> border;  ///< points that check_border() evaluates
};

/// Returns the region of a part that is checked.
InspectedRegion region_of(const PathOptions& path);

/// Computes the distance between cutting edge and surface for every block: at its end, at half its length, and where
/// the point of contact crosses the border of the region. The point of contact is the point of the edge that is closest
/// to the surface. Adds a finding `gouge` if the edge is below the surface by more than the tolerance, and a finding
/// `excess` if it is above the surface by more than the tolerance. Only points inside the region are checked.
/// Consecutive blocks give one finding. Blocks that only lower Z are checked only for `gouge`.
ContactFigures check_contact(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings);

/// Checks the remaining material at the points of ContactFigures::border. At these points, a block does not reach the
/// surface, but other blocks may have cut there. The height of the material after all cuts is compared with the height
/// after a cut that touches the surface. Adds a finding `excess` if the difference is larger than the tolerance.
void check_border(const TurnedPart& part, const TurningCuts& cuts, const Envelope& envelope, ContactFigures& figures,
                  FindingList& findings);

}  // namespace retrace::fabrication::turning
