#pragma once

// Effect of facet forms on the field that a cell returns. Polygons are divided into smaller ones, over each of which
// the phase is nearly linear.

#include <cstddef>

#include "raytrace/observers/coherent_group.h"
#include "surface_models/facet_form.h"

namespace retrace::raytrace {

/// Parameters for the subdivision of polygons.
struct FormedPolicy {
  double wave_number = 0.0;  ///< rad per mm
  /// Target for the phase error, in rad. It is the root mean square difference between the phase and a linear function,
  /// over a small polygon. It applies to the polygon with the highest power if the whole polygon has an error of 1 rad.
  /// The mean error is 0, so that the field of a small polygon has a relative error of half of the square.
  /// Small polygons scatter the error into wide angles. If the error of the whole polygon is smaller, the target is
  /// therefore smaller, too, in proportion to the cubic root. For a polygon with less power, the target is larger, in
  /// proportion to the inverse fourth root of the power.
  double phase_left_rad = 0.05;
  double strongest = 0.0;  ///< highest power of a polygon, in all copies of its group
  std::size_t most_pieces = 20'000;
};

/// Returns the field including the phases of the facets with a form that the light has met (docs/theory/form.md). Every
/// polygon is divided into convex polygons, each with a plane wave. Powers and amplitudes are unchanged. The new
/// polygons have no hits.
/// \throw BudgetError if more than FormedPolicy::most_pieces polygons are needed
CoherentGroup formed(const CoherentGroup& group, const surface_models::FacetForm& form, const FormedPolicy& policy);

/// Returns the maximum deflection by the form, in direction cosines, of a small polygon from the original polygons.
double turn_between(const CoherentGroup& plane, const CoherentGroup& formed);

}  // namespace retrace::raytrace
