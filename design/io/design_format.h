#pragma once

// Format of design files (retrace.design/1). Readers, writers and the documentation use this description of all keys.

#include "core/schema/schema.h"

namespace retrace::design {

/// Returns the keys of design files (docs/design_file.md).
const schema::Format& design_format();

}  // namespace retrace::design
