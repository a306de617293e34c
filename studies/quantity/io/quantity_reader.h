#pragma once

#include "studies/design/table_reader.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// One [[quantity]] of a study, which may stand for several, such as every point of a standard. \throw InputError
Quantities read_quantity(const DesignDocument& document, const toml::table& table);

}  // namespace retrace::studies
