#pragma once

#include "core/schema/schema.h"

namespace retrace::studies {

/// The keys of design files (docs/design_file.md).
const schema::Format& design_format();

}  // namespace retrace::studies
