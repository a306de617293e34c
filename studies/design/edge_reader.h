#pragma once

#include "geometry/part_spec.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {

/// Reads what rounds and chamfers roots and rims from `[surface]` into `part`, whose element and array are known.
/// \throw InputError for edges that leave nothing of a facet, or that the land between prisms is too narrow for
void read_edges(TableReader& surface, geometry::PartSpec& part);

}  // namespace retrace::studies
