#pragma once

#include <optional>

#include "studies/design/design.h"
#include "studies/design/design_document.h"

namespace retrace::studies {

/// `[front]`: the file of a curved face through which light enters; none without such a table. The file is named, not
/// read. \throw InputError for values that mean nothing, and for parts that have no place for a front
std::optional<FrontFile> read_front(const DesignDocument& document, const Design& design);

}  // namespace retrace::studies
