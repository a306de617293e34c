#pragma once

// Reads the STEP files of a design: its entrance surface and its substrate.

#include "design/design.h"

namespace retrace::design {

/// Reads the STEP files that contain the entrance surface and the substrate of a design, and checks the substrate. Does
/// not change designs without such files.
/// \throw InputError that names file, line and key, if a file cannot be read or the substrate is too steep or curved
void read_step_faces(Design& design);

}  // namespace retrace::design
