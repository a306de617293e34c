#pragma once

// Reads the curved entrance face of a design from the file of a turned part or from an STL file.

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Returns the curved entrance face that the file of a design contains, in the part frame.
/// \param origin_mm position of the origin of the file
/// \throw InputError that names the file, if it cannot be read or does not cover the part
/// \pre design.entrance->file()
geometry::Entrance entrance_of_file(const Design& design, const geometry::Part& part, const geometry::Vec3& origin_mm);

}  // namespace retrace::design
