#pragma once

// Reads the curved entrance face of a design from a file. The file describes a turned part or is an STL file.

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Reads the curved entrance face of a design from its file, and returns the face in the part frame.
/// \param origin_mm position of the file's origin in the part frame
/// \throw InputError that names the file, if the file cannot be read or the face does not cover the part
/// \pre design.entrance->file() is not null
geometry::Entrance entrance_of_file(const Design& design, const geometry::Part& part, const geometry::Vec3& origin_mm);

}  // namespace retrace::design
