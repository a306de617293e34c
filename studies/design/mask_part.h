#pragma once

// Applies the mask of a design: which elements of its array are there.

#include "geometry/elements/facet_planes.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The elements that the mask of a design leaves, as nominal planes (errors of angle that all elements share included).
/// Cells are those of a fabrication job: partial elements are not there. \pre design.mask()
/// \throw InputError for a mask that cannot be read or has not one pixel for each cell, and beside random tilts
geometry::FacetPlanes elements_of_mask(const Design& design);

}  // namespace retrace::studies
