#pragma once

// Parts whose elements stand on a substrate: whether it can carry them, and how much wall stands open between
// neighbours.

#include "geometry/part/part.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// The substrate of a design as it lies under its part. \pre spec.substrate
SubstrateSurface substrate_surface_of(const PartSpec& spec);

/// Measures the substrate and checks that it can carry the elements. \pre spec.substrate, a finite array
/// \throw InputError, whose text begins with "must" or "is not", where it is not finite, rises by more than 60 degrees,
/// bends more tightly than an element is wide, makes a facet stand upright, or pulls pins apart
SubstrateMeasures check_substrate(const PartSpec& spec);

/// The diameter of the circle round an element's aperture.
double width_across_mm(const Element& element);

/// What stands open between neighbouring elements of a part.
struct InnerWalls {
  double area_mm2 = 0.0;
  double highest_mm = 0.0;  ///< largest step in height from an element to the next
  /// Of their area: as seen along the substrate's mean normal, which they hide from light that comes that way.
  double projected_mm2 = 0.0;
};

/// Of a finite part. \param towards unit vector along which they are projected
InnerWalls inner_walls(const Part& part, const Vec3& towards);

}  // namespace retrace::geometry
