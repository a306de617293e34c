#pragma once

// Reads the table [entrance_surface] of a design.

#include <optional>

#include "core/schema/document.h"
#include "design/design.h"

namespace retrace::design {

/// Reads the curved entrance face of a design. Returns nothing if the document has no table [entrance_surface]. Files
/// that are named in the document are not read.
/// \throw InputError that names file, line and key, if a formula cannot be parsed
std::optional<CurvedEntrance> read_entrance(const schema::Document& document);

/// Sets the default of the angle between the elements and the axis of an inclined entrance face: the angle of
/// refraction of light along the reference axis. This reads the refractive index of the body and the spectrum of the
/// light, if it is a file.
/// \throw InputError that names file, line and key, if the index or the spectrum is not known
void find_pin_angle(Design& design);

}  // namespace retrace::design
