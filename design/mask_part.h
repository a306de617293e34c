#pragma once

// Applies the mask of a design, which selects elements of its array.

#include "design/design.h"
#include "geometry/elements/facet_planes.h"

namespace retrace::design {

/// Returns the elements that the mask selects, with nominal planes. The planes include angle errors that all elements
/// have in common. Only elements that a fabrication job would cut are returned; partial elements are omitted.
/// \pre design.mask()
/// \throw InputError if the mask cannot be read or does not have one pixel for each cell, and for random tilts
geometry::FacetPlanes elements_of_mask(const Design& design);

}  // namespace retrace::design
