#pragma once

// Zones of a part: their elements, and the fraction of light that hits several zones. Because of this light, a part is
// not exactly the sum of its zones.

#include <optional>
#include <vector>

#include "design/design.h"
#include "design/optical_model.h"
#include "geometry/part/part.h"

namespace retrace::studies {

/// Elements of a zone, and the distance that light travels sideways in the zone.
struct ZoneReport {
  geometry::ZoneElements elements;
  /// Mean distance, in plan, between the first and the last point at which returned light hits the back of the part. It
  /// refers to light that enters along the normal and hits this zone first. None if no light returns, and for a curved
  /// entrance face.
  std::optional<double> lateral_shift_mm;
};

/// Light at one incidence, averaged over azimuths.
struct ZoneCrossing {
  double incidence_deg = 0.0;
  double fraction = 0.0;  ///< fraction of the returned light whose first and last point are in different zones
};

struct ZonesReport {
  std::vector<ZoneReport> zones;
  std::vector<ZoneCrossing> crossings;
};

/// Computes the report on the zones with single rays from low-discrepancy points on the entrance face. At every
/// interface, only the stronger branch is traced. The results have relative errors of a few percent. Rough facets are
/// treated as smooth.
/// \pre design.zoned()
ZonesReport report_zones(const design::Design& design, const design::OpticalModel& model);

}  // namespace retrace::studies
