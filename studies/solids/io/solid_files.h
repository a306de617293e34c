#pragma once

// Writes solids as STL, OBJ, glTF or STEP, and the document of `retrace export`.

#include <string>

#include "studies/solids/solids.h"

namespace retrace::studies {

enum class SolidFormat { stl, obj, gltf, step };

/// By the ending of a file's name: .stl, .obj, .glb, .step or .stp, in small or capital letters. \throw InputError
/// otherwise
SolidFormat solid_format(const std::string& file);

/// The content of a file of that format. \throw InputError if STEP cannot hold the solid: it touches itself along
/// edges, or an edge is too short; if it is too large for glTF; or for a material that glTF is to tell the index of
std::string solid_text(const Solid& solid, SolidFormat format);

/// The document `retrace.export/1`. \param file empty if none is written
std::string solid_json(const Solid& solid, const std::string& file);

/// The figures as a table for the terminal.
std::string solid_table(const Solid& solid);

}  // namespace retrace::studies
