#pragma once

#include <string>
#include <string_view>

#include "studies/design/design_document.h"

namespace retrace::studies {

/// Checks that a design has no table or key that retrace does not know, and none that this version does not serve yet
/// with a value other than the one that means "not used". Reports the first in file order.
/// \throw InputError with a "did you mean" where a known name is close.
void check_keys(const DesignDocument& document);

/// What is wrong with `name` as the full name of a key of a design, such as "element.base_mm", with a "did you mean"
/// where a known name is close; empty if a design may have it.
std::string complaint_about_key(std::string_view name);

}  // namespace retrace::studies
