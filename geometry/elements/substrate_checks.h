#pragma once

// Checks whether a substrate is suitable for the elements of a part.

#include "geometry/elements/part_spec.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// Returns the surface of the substrate of a part. Its coordinates are relative to the centre of the part.
/// \pre spec.substrate is set
SubstrateSurface substrate_surface_of(const PartSpec& spec);

/// Measures the substrate and checks that it is suitable for the elements. Its heights must be finite, its slope must
/// be at most 60 degrees, and its radius of curvature must be at least the width of an element. The facets of elements
/// on the substrate must be at most 88 degrees steep, and neighbouring pins must touch each other.
/// \pre spec.substrate is set; the array is finite
/// \throw InputError if a check fails; its text begins with "must" or "is not"
SubstrateMeasures check_substrate(const PartSpec& spec);

/// Returns the diameter of the circumscribed circle of an element's aperture.
double width_across_mm(const Element& element);

}  // namespace retrace::geometry
