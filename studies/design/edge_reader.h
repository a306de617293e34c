#pragma once

#include "core/schema/document.h"
#include "geometry/part_spec.h"

namespace retrace::studies {

/// Reads what rounds and chamfers roots and rims from `[surface]` into `part`, whose element and array are known.
/// \throw InputError for edges that leave nothing of a facet, or that the land between prisms is too narrow for
void read_edges(const schema::Document& document, geometry::PartSpec& part);

}  // namespace retrace::studies
