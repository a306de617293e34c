#pragma once

// Triangles of the solids of a STEP file. Part of the program that reads STEP files.

#include <filesystem>

#include "geometry/part/solid_mesh.h"

namespace retrace::geometry {

/// Reads all solids of a STEP file and divides their faces into triangles.
/// \param chord_mm maximum distance between a curved face and its triangles
/// \throw std::runtime_error, with a text that begins with "must", "is" or "has", if the file is damaged or contains no
///     solid
SolidMesh solids_of_file(const std::filesystem::path& file, double chord_mm);

}  // namespace retrace::geometry
