#pragma once

// Makes the curved entrance face of a design, from its keys or from its file, and places it over the part.

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Returns the curved entrance face of a design in the part frame, and reads its file if there is one. The origin of
/// the face is at z = thickness_mm and at CurvedEntrance::centre_mm. The face must cover the whole part, and it must be
/// above the part's back. It must not fold. A turned face must cover the part with its turned region.
/// \throw InputError that names file and line
/// \pre design.entrance
geometry::Entrance entrance_of_design(const Design& design, const geometry::Part& part);

}  // namespace retrace::design
