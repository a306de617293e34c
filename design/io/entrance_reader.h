#pragma once

// Reads the table [entrance_surface] of a design.

#include <optional>

#include "core/schema/document.h"
#include "design/design.h"

namespace retrace::design {

/// Reads the curved entrance face of a design. Returns nothing if the document has no table [entrance_surface]. Does
/// not read the file of an entrance face.
/// \throw InputError that names file, line and key, if a formula cannot be parsed
std::optional<CurvedEntrance> read_entrance(const schema::Document& document);

/// Sets the pin angle of an inclined entrance face to its default if the design does not specify it. The pin angle is
/// the angle between the axes of the elements and the axis of the face. Its default is the angle of refraction of light
/// along the reference axis. The function therefore reads the refractive index of the body and the spectrum of the
/// light.
/// \throw InputError that names file, line and key, if the index or the spectrum cannot be determined
void find_pin_angle(Design& design);

}  // namespace retrace::design
