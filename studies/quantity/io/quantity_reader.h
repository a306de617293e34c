#pragma once

#include "studies/design/table_reader.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// One [[quantity]] of a study. \throw InputError
std::shared_ptr<const Quantity> read_quantity(const DesignDocument& document, const toml::table& table);

}  // namespace retrace::studies
