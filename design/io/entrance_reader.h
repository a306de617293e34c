#pragma once

// Reads the table [entrance_surface] of a design.

#include <optional>

#include "core/schema/document.h"
#include "design/design.h"

namespace retrace::design {

/// Reads the curved entrance face of a design. Returns nothing if the document has no table [entrance_surface]. Files
/// that are named in the document are not read.
/// \throw InputError that names file, line and key, if a formula cannot be parsed
std::optional<CurvedEntrance> read_entrance(const schema::Document& document);

}  // namespace retrace::design
