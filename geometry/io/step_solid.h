#pragma once

// Reads the solids of STEP files. A separate program uses OpenCASCADE to read the file and to divide its faces into
// triangles.

#include <filesystem>

#include "geometry/part/solid_mesh.h"

namespace retrace::geometry {

/// Reads all solids of a STEP file (AP203, AP214, AP242), in mm. The triangles of plane faces are exactly in their
/// planes.
/// \param chord_mm maximum distance between a curved face and its triangles
/// \throw InputError that names the file, if it cannot be read or contains no solid
SolidMesh read_step_solid(const std::filesystem::path& file, double chord_mm);

}  // namespace retrace::geometry
