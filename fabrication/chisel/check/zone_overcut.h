#pragma once

// Computes the overcut of hexagonal cube corners in jobs with zones. Their cavities are triangular and remove material
// outside of the hexagons, also at the border to another zone.

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/verification_model.h"

namespace retrace::fabrication {

struct ZoneOvercut {
  double volume_mm3 = 0.0;    ///< volume removed outside of all hexagons or below the facets of other zones
  double area_mm2 = 0.0;      ///< area, seen along Z, of the facets of other zones that are damaged
  double deepest_mm = 0.0;    ///< maximum depth of the material that is removed from these facets, along z
  std::int64_t elements = 0;  ///< number of elements that lose material
};

/// Computes the overcut on a dense grid of points. At the end of each dihedral edge, a triangular cavity extends beyond
/// its hexagon in a small corner. Each half of this corner is inside the hexagon of one neighbour. A half is omitted if
/// this neighbour belongs to the same zone and is cut. The relative error of areas and volumes is a few thousandths.
/// \param is_cut for each element: true if it is cut
/// \pre the job has zones of hexagonal cube corners
ZoneOvercut zone_overcut(const VerificationModel& workpiece, const std::vector<bool>& is_cut);

}  // namespace retrace::fabrication
