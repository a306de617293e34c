#pragma once

// The format of design files (retrace.design/1), as the rows that readers, writers and documentation walk.

#include "core/schema/schema.h"

namespace retrace::studies {

/// The keys of design files (docs/design_file.md).
const schema::Format& design_format();

}  // namespace retrace::studies
