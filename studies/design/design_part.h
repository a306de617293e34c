#pragma once

// The part of a design of elements, with its mask and its table of facet planes applied.

#include "geometry/part/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The part of a design: the elements that its mask leaves, with the planes of their own facets if it names a table.
/// \throw InputError as geometry::build_part(), and for a table or a mask that cannot be read or understood
geometry::Part part_of(const Design& design);

}  // namespace retrace::studies
