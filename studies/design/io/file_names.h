#pragma once

// Files that a design names.

#include <string_view>

#include "studies/design/design.h"

namespace retrace::studies {

/// For who has the design alone. \pre the design is from a file
/// \throw InputError at the key that names a file. \param why that is no use: "which the live page cannot read"
void check_names_no_file(const Design& design, std::string_view why);

/// Returns the factor from the unit of a design's STL file to mm.
/// \param table table that names the file: "part" or "front"
double mesh_scale(const Design& design, std::string_view table);

}  // namespace retrace::studies
