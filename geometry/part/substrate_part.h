#pragma once

// Parts whose elements are placed on a substrate. Checks that the substrate can carry the elements, and measures the
// exposed walls between neighbours.

#include "geometry/part/part.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// Returns the substrate of a design at its position under the part.
/// \pre spec.substrate is set
SubstrateSurface substrate_surface_of(const PartSpec& spec);

/// Measures the substrate and checks that it can carry the elements. The substrate must be finite, must rise by at most
/// 60 degrees, and must not have a radius of curvature below the width of an element. On it, no facet may be vertical,
/// and neighbouring pins must touch each other.
/// \pre spec.substrate is set; the array is finite
/// \throw InputError if a check fails; its text begins with "must" or "is not"
SubstrateMeasures check_substrate(const PartSpec& spec);

/// Returns the diameter of the circle around an element's aperture.
double width_across_mm(const Element& element);

/// Exposed walls between neighbouring elements of a part.
struct InnerWalls {
  double area_mm2 = 0.0;
  double highest_mm = 0.0;  ///< largest difference in height between neighbouring elements
  /// Area of the walls projected along the substrate's mean normal. The walls block this cross section for light from
  /// that direction.
  double projected_mm2 = 0.0;
};

/// Measures the walls of a finite part.
/// \param towards unit vector along which the walls are projected
InnerWalls inner_walls(const Part& part, const Vec3& towards);

}  // namespace retrace::geometry
