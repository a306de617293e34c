#pragma once

// Reads the files of parts that are turned (retrace.turned_part/1).

#include <cstddef>
#include <string>
#include <string_view>

#include "core/schema/schema.h"
#include "fabrication/turning/part.h"

namespace retrace::fabrication::turning {

/// The format of part files (retrace.turned_part/1).
const schema::Format& turned_part_format();

/// Reads the text of a part file, with all checks that need no path: a surface that is finite and has no vertical
/// slope, boundaries that are closed and do not cross, a tool that clears. \throw InputError with file, line and key
TurnedPart parse_turned_part(std::string_view text, const std::string& source_name);

}  // namespace retrace::fabrication::turning
