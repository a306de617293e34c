#pragma once

// Overcut of hexagonal cube corners in zones: material that their triangular cavities remove outside of the hexagons of
// their zone.

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/workpiece.h"

namespace retrace::fabrication {

struct ZoneOvercut {
  double volume_mm3 = 0.0;    ///< volume removed outside of all hexagons or below the facets of other zones
  double area_mm2 = 0.0;      ///< area, in plan, of the removed material of facets of other zones
  double deepest_mm = 0.0;    ///< maximum depth of the removed material of these facets, along z
  std::int64_t elements = 0;  ///< number of elements that lose material
};

/// Computes the overcut by sampling the surface of the deepest cavity on a dense grid. At the end of each dihedral
/// edge, a triangular cavity extends beyond its hexagon in a small corner, which the grid covers. Each half of this
/// corner is inside the hexagon of one neighbour. If this neighbour belongs to the same zone and is cut, that half is
/// omitted. The relative error of areas and volumes is a few thousandths.
/// \param is_cut for each element: true if it is cut
/// \pre the job has zones of hexagonal cube corners
ZoneOvercut zone_overcut(const Workpiece3d& workpiece, const std::vector<bool>& is_cut);

}  // namespace retrace::fabrication
