#pragma once

// Effect of facet forms on the field that a cell returns. Polygons are divided into smaller ones, over each of which
// the phase is nearly linear.

#include <cstddef>

#include "raytrace/observers/coherent_group.h"

namespace retrace::raytrace {

/// Parameters for the subdivision of polygons.
struct FormedPolicy {
  double wave_number = 0.0;  ///< rad per mm
  /// Target for the phase error in rad. The phase error is the root mean square difference between the phase and a
  /// linear function, over one of the small polygons. The mean difference is 0, so that the field of a small polygon
  /// has a relative error of half of the square of the phase error.
  ///
  /// The value applies to the polygon with the highest power if its phase error before the subdivision is 1 rad. Small
  /// polygons scatter the error into wide angles. The target is therefore proportional to the cubic root of the phase
  /// error before the subdivision. For a polygon with less power, the target is larger, in proportion to the inverse
  /// fourth root of the power.
  double target_phase_error_rad = 0.05;
  double strongest = 0.0;  ///< highest power of a polygon, in all copies of its group
  std::size_t max_polygons = 20'000;
};

/// Returns the field with the additional phases of all forms (FieldHit::form) that the light has met
/// (docs/theory/form.md). Every polygon is divided into convex polygons, each with a plane wave. Powers and amplitudes
/// are unchanged. FieldPolygon::hits of the new polygons is empty.
/// \throw BudgetError if more than FormedPolicy::max_polygons polygons are needed
CoherentGroup formed(const CoherentGroup& group, const FormedPolicy& policy);

/// Returns the maximum deflection that the form causes, in direction cosines. The deflection of a small polygon is the
/// difference between its direction and the nearest direction of an original polygon.
double max_deflection(const CoherentGroup& plane, const CoherentGroup& formed);

}  // namespace retrace::raytrace
