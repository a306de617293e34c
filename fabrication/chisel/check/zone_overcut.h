#pragma once

// What triangular cavities of hexagonal cube corners take beside the hexagons of their zone, where zones meet.

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/workpiece.h"

namespace retrace::fabrication {

struct ZoneOvercut {
  double volume_mm3 = 0.0;    ///< that cavities take beyond all hexagons, or deeper than the facets of other zones
  double area_mm2 = 0.0;      ///< of other zones' apertures, in plan, whose facets they take
  double deepest_mm = 0.0;    ///< below one of these facets, along z
  std::int64_t elements = 0;  ///< of which something is taken
};

/// By the lowest of all cavities at places that lie densely over what each opens beside the hexagons of its zone: a
/// cavity's corner at a dihedral edge is the half of two neighbouring hexagons, which the neighbours take where they
/// are cut. Areas and volumes are those of the sums to some thousandths.
/// \param is_cut of each element \pre a job of zones of hexagonal cube corners
ZoneOvercut zone_overcut(const Workpiece3d& workpiece, const std::vector<bool>& is_cut);

}  // namespace retrace::fabrication
