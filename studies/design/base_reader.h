#pragma once

#include "core/schema/document.h"
#include "geometry/part_spec.h"

namespace retrace::studies {

/// Reads `[base]` into part.base, which stays empty without such a table.
/// \throw InputError for values that mean nothing, and for arrays that stand on no base
void read_base(const schema::Document& document, geometry::PartSpec& part);

/// Checks that the base can carry the elements, errors of angle included. \throw InputError at base_shape_key()
void check_base(const schema::Document& document, const geometry::PartSpec& part);

}  // namespace retrace::studies
