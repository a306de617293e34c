#pragma once

#include "core/error.h"
#include "studies/design/design.h"
#include "studies/design/design_document.h"

namespace retrace::studies {

/// Reads `[base]` into part.base, which stays empty without such a table, and says where its shape was given.
/// \throw InputError for values that mean nothing, and for arrays that stand on no base
InputLocation read_base(const DesignDocument& document, geometry::PartSpec& part);

/// Checks that the base can carry the elements, errors of angle included.
/// \throw InputError at the key that gives its shape
void check_base_of(const Design& design);

}  // namespace retrace::studies
