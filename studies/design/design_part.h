#pragma once

// The part of a design of elements, with its mask and its table of facet planes applied, and one element of it.

#include "geometry/part/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The part of a design: the elements that its mask leaves, with the planes of their own facets if it names a table.
/// \throw InputError as geometry::build_part(), and for a table or a mask that cannot be read or understood
geometry::Part part_of(const Design& design);

/// One element of an array by itself, on its own piece of the plate. \pre it is a design of elements
Design single_element_of(const Design& design);

}  // namespace retrace::studies
