#pragma once

// What the forms of facets do to the field that a cell sends back: its polygons in pieces on which their phases are
// linear.

#include <cstddef>

#include "raytrace/observers/coherent_group.h"
#include "surface_models/facet_form.h"

namespace retrace::raytrace {

/// How finely polygons are cut.
struct FormedPolicy {
  double wave_number = 0.0;  ///< rad per mm
  /// Root mean square, over a piece of the strongest polygon, of the phases that a linear one leaves, where the whole
  /// polygon would leave 1 rad. Their mean is 0, so that the field of the piece along its own wave is right to half the
  /// square. What they scatter goes as wide as the pieces are narrow; for it to be as faint in any direction, pieces of
  /// polygons that would leave less are finer, with its cubic root. Of a polygon with less power they are wider, with
  /// the fourth root: its field counts for less.
  double phase_left_rad = 0.05;
  double strongest = 0.0;  ///< power of that polygon, in all copies of its group
  std::size_t most_pieces = 20'000;
};

/// The same field with the phases of the formed facets that its light has met (docs/theory/form.md): every polygon cut
/// into convex pieces, each a plane wave again. Powers and amplitudes stay; pieces know no hits.
/// \throw BudgetError if more than FormedPolicy::most_pieces are needed
CoherentGroup formed(const CoherentGroup& group, const surface_models::FacetForm& form, const FormedPolicy& policy);

/// By how much, in cosines, the form turns light: the farthest that a piece lies from the polygons' directions.
double turn_between(const CoherentGroup& plane, const CoherentGroup& formed);

}  // namespace retrace::raytrace
