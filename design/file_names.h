#pragma once

// Two functions: one checks that a design refers to no files; the other determines the units of the STL files to which
// a design refers.

#include <string_view>

#include "design/design.h"

namespace retrace::design {

/// Checks that a design names no files, for environments that have only the text of the design.
/// \pre the design was read from a file
/// \throw InputError at the key that names a file
/// \param why relative clause that the message ends with, such as "which the live page cannot read"
void require_no_files(const Design& design, std::string_view why);

/// Returns the factor that converts the unit of a design's STL file to mm.
/// \param table name of the TOML table that names the STL file: "part" or "entrance_surface"
double mesh_scale(const Design& design, std::string_view table);

}  // namespace retrace::design
