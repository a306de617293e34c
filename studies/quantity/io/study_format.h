#pragma once

// The format of study files, as the rows that readers and documentation walk.

#include "core/schema/schema.h"

namespace retrace::studies {

/// Of the words of `kind` of a quantity, the first that is a PlainQuantity; its others follow in their order.
inline constexpr std::size_t kFirstPlainKind = 4;

/// Keys of study files: what varies, what is asked of every design, and how it is computed and made.
const schema::Format& study_format();

}  // namespace retrace::studies
