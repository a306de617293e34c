#pragma once

#include <string>
#include <string_view>

#include "fabrication/turning/part.h"

namespace retrace::fabrication::turning {

/// Reads the text of a part file (`retrace.turned_part/1`, docs/turning_file.md), with all checks that need no path: a
/// surface that is finite and has no vertical slope, boundaries that are closed and do not cross, a tool that clears.
/// \throw InputError with file, line and key
TurnedPart parse_turned_part(std::string_view text, const std::string& source_name);

}  // namespace retrace::fabrication::turning
