#pragma once

#include "geometry/part_spec.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {

/// Reads `[[surface.scratches]]` of prisms into `part`.
/// \throw InputError for scratches of other elements, or that leave the facet, overlap, or are deeper than half their
///        width
void read_scratches(const DesignDocument& document, TableReader& surface, geometry::PartSpec& part);

}  // namespace retrace::studies
