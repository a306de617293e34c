#pragma once

// Checks whether a substrate can carry the elements of a part.

#include "geometry/elements/part_spec.h"
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

}  // namespace retrace::geometry
