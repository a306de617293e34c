#pragma once

#include "geometry/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The part of a design, with the planes of its own facets if it names a table of them.
/// \throw InputError as geometry::build_part(), and for a table that cannot be read or understood
geometry::Part part_of(const Design& design);

}  // namespace retrace::studies
