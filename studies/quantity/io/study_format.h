#pragma once

// Format of study files, as one row for each key. The readers and the documentation use these rows.

#include <string_view>

#include "core/schema/schema.h"

namespace retrace::studies {

/// Index of the first word of the key `kind` that is a PlainQuantity. The words of the other plain quantities follow in
/// the order of the enumeration.
inline constexpr std::size_t kFirstPlainKind = 4;

/// Returns the keys of study files: parameters, quantities, analysis and machining.
const schema::Format& study_format();

/// Returns the current word for a word of the key `kind` of a quantity in former versions. Returns any other text
/// unchanged.
std::string_view current_kind(std::string_view kind);

}  // namespace retrace::studies
