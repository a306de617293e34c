#pragma once

// Part of a design that consists of elements, after its mask and its table of facet planes are applied. Also designs
// with only one of its elements.

#include "geometry/part/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// Returns the part of a design. It has the elements that the mask selects, and the facet planes of the table if there
/// is one.
/// \throw InputError under the same conditions as geometry::build_part(), and for an invalid table or mask
geometry::Part part_of(const Design& design);

/// Returns a design with only one element of the array, on the piece of plate that belongs to the element.
/// \pre the design consists of elements
Design single_element_of(const Design& design);

}  // namespace retrace::studies
