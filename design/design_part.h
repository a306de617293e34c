#pragma once

// Builds the part of a design that consists of elements, and applies its mask and its table of facet planes. Also makes
// designs that contain only one element of another design.

#include "design/design.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Returns the part of a design. It has the elements that the mask selects, and the facet planes of the table if there
/// is one.
/// \throw InputError under the same conditions as geometry::build_part(), and for an invalid table or mask
geometry::Part part_of(const Design& design);

/// Returns a design with only one element of the array. Its plate is the portion of the design's plate that belongs to
/// this element.
/// \pre the design consists of elements
Design single_element_of(const Design& design);

}  // namespace retrace::design
