#pragma once

// Reads the files of parts that are turned (retrace.turned_part/1).

#include <string>
#include <string_view>

#include "core/schema/schema.h"
#include "fabrication/turning/part.h"

namespace retrace::fabrication::turning {

/// Returns the schema of part files (retrace.turned_part/1). A part file contains the data of a TurnedPart.
const schema::Format& turned_part_format();

/// Reads the text of a part file and makes all checks that do not need the path. The surface must be finite without
/// vertical slopes. Boundaries must be closed and must not cross. The tool must clear the surface.
/// \throw InputError with file, line and key
TurnedPart parse_turned_part(std::string_view text, const std::string& source_name);

}  // namespace retrace::fabrication::turning
