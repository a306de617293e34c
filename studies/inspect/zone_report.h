#pragma once

// Zones of a part: what stands in each, and how much of the light meets more than one, so that their sum is not the
// part.

#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "studies/design/design.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {

/// A zone of a part.
struct ZoneReport {
  geometry::ZoneElements elements;
  /// Mean distance in plan between the first and the last place where light that comes back meets the back of the part,
  /// of light that enters along the normal and meets this zone first; none if none comes back, and behind a curved
  /// front.
  std::optional<double> wander_mm;
};

/// Light from one incidence, of all azimuths.
struct ZoneCrossing {
  double incidence_deg = 0.0;
  double share = 0.0;  ///< of the light that comes back, whose first and last place lie in different zones
};

struct ZonesReport {
  std::vector<ZoneReport> zones;
  std::vector<ZoneCrossing> crossings;
};

/// By single paths, the stronger branch at every interface, from a grid of places of the entrance face: to a few parts
/// in a hundred of what is told. Rough facets are taken as smooth ones. \pre design.zoned()
ZonesReport report_zones(const Design& design, const OpticalModel& model);

}  // namespace retrace::studies
