#pragma once

#include "core/schema/document.h"
#include "geometry/part_spec.h"

namespace retrace::studies {

/// Reads `[[surface.scratches]]` of prisms into `part`.
/// \throw InputError for scratches of other elements, or that leave the facet, overlap, or are deeper than half their
///        width
void read_scratches(const schema::Document& document, geometry::PartSpec& part);

}  // namespace retrace::studies
