#pragma once

// Reads the curved entrance face of a design from its file and places it over the part.

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Reads the curved entrance face of a design and transforms it to the part frame. Heights in the file are relative to
/// z = thickness_mm, and the origin of the file is at EntranceFile::centre_mm. The face must cover the whole part, and
/// it must be above the highest point of the part's back. A turned face must cover the part with its turned region.
/// \throw InputError that names file and line
/// \pre design.entrance
geometry::Entrance entrance_of_design(const Design& design, const geometry::Part& part);

}  // namespace retrace::design
