#pragma once

// Writes solids as STL, OBJ, glTF or STEP, and the document of `retrace export`.

#include <string>

#include "studies/solids/solids.h"

namespace retrace::studies {

enum class SolidFormat { stl, obj, gltf, step };

/// Returns the format for the ending of a file's name, in lower or upper case: .stl, .obj, .glb, .step or .stp.
/// \throw InputError for other endings
SolidFormat solid_format(const std::string& file);

/// Returns the content of a file in the given format.
/// \throw InputError for STEP if the solid touches itself along edges or has too short edges
/// \throw InputError for glTF if the solid is too large, or if its material has no refractive index
std::string solid_text(const Solid& solid, SolidFormat format);

/// Returns the description of a curved entrance face that a format can store.
inline SolidEntrance solid_entrance(SolidFormat format) {
  return format == SolidFormat::step ? SolidEntrance::exact : SolidEntrance::triangles;
}

/// Returns a line with the size of a STEP file and the time for writing it, or an empty text if both are small.
std::string step_notice(const Solid& solid);

/// Returns the document `retrace.export/2`.
/// \param file name of the written file; empty if there is none
std::string solid_json(const Solid& solid, const std::string& file);

/// Returns the numbers of elements and triangles, the size, the volume and the surface area of a solid as a table for
/// the terminal.
std::string solid_table(const Solid& solid);

}  // namespace retrace::studies
