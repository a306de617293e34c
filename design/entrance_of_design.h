#pragma once

// Makes the curved entrance face of a design from keys or from a file, and places it in front of the part.

#include <optional>

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/exact_solid.h"
#include "geometry/part/part.h"

namespace retrace::design {

/// Returns the curved entrance face of a design in the part frame, and reads the file of the face if there is one. The
/// origin of the face is at CurvedEntrance::centre_mm and z = thickness_mm. Above an OffsetSubstrate, the height of the
/// origin follows from the substrate instead. The face must cover the whole part, must be above the back of the part,
/// and must not fold. If the face is made by turning, its turned region must cover the whole part.
/// \throw InputError that names file and line
/// \pre design.entrance has a value
geometry::Entrance entrance_of_design(const Design& design, const geometry::Part& part);

/// Returns the curved entrance face of a design in closed form, or nothing if it is neither a plane, nor a circular
/// cylinder, nor a sphere.
/// \pre design.entrance has a value
std::optional<geometry::FaceSurface> closed_form_of_entrance(const Design& design, const geometry::Part& part);

}  // namespace retrace::design
