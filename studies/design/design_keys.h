#pragma once

#include "studies/design/design_document.h"

namespace retrace::studies {

/// Checks that a design has no table or key that retrace does not know, and none that this version does not serve yet
/// with a value other than the one that means "not used". Reports the first in file order.
/// \throw InputError with a "did you mean" where a known name is close.
void check_keys(const DesignDocument& document);

}  // namespace retrace::studies
