#pragma once

// Format of study files, as rows that are used by readers and for the documentation.

#include "core/schema/schema.h"

namespace retrace::studies {

/// Index of the first word of a quantity's `kind` that is a PlainQuantity. The other plain quantities follow in their
/// order.
inline constexpr std::size_t kFirstPlainKind = 4;

/// Returns the keys of study files: parameters, quantities, analysis and machining.
const schema::Format& study_format();

}  // namespace retrace::studies
