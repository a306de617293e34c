#pragma once

// Material that the triangular cavities of hexagonal cube corners remove outside of the hexagons of their zone.

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/workpiece.h"

namespace retrace::fabrication {

struct ZoneOvercut {
  double volume_mm3 = 0.0;    ///< volume removed outside of all hexagons or below the facets of other zones
  double area_mm2 = 0.0;      ///< area, in plan, in which facets of other zones are removed
  double deepest_mm = 0.0;    ///< maximum depth of the removed material below these facets, along z
  std::int64_t elements = 0;  ///< number of elements that lose material
};

/// Computes the overcut from the lowest of all cavities on a dense grid of points. At the end of
/// each dihedral edge, a cavity extends beyond its hexagon in a small corner. The grid covers these corners. Each half
/// of a corner lies in the hexagon of one neighbour. A half is omitted if this neighbour belongs to the same zone and
/// is cut. The relative error of areas and volumes is a few thousandths. \param is_cut true for each element that is
/// cut \pre the job has zones of hexagonal cube corners
ZoneOvercut zone_overcut(const Workpiece3d& workpiece, const std::vector<bool>& is_cut);

}  // namespace retrace::fabrication
