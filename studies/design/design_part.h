#pragma once

// Part of a design of elements, with its mask and its table of facet planes applied, and single elements of it.

#include "geometry/part/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// Returns the part of a design. It has the elements that the mask selects, and the facet planes of the table if there
/// is one.
/// \throw InputError as geometry::build_part(), and for an invalid table or mask
geometry::Part part_of(const Design& design);

/// Returns a design with a single element of the array, on its own part of the plate.
/// \pre the design consists of elements
Design single_element_of(const Design& design);

}  // namespace retrace::studies
