#pragma once

// Format of design files (retrace.design/1), as rows that are used by readers, writers and the documentation.

#include "core/schema/schema.h"

namespace retrace::studies {

/// Returns the keys of design files (docs/design_file.md).
const schema::Format& design_format();

}  // namespace retrace::studies
