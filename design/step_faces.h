#pragma once

// Reads the STEP files of a design: its entrance surface and its substrate.

#include "design/design.h"

namespace retrace::design {

/// Reads the STEP files that contain the entrance surface and the substrate of a design, and checks the substrate. Does
/// not change designs without such files.
/// \throw InputError that names file, line and key, if a file cannot be read or the substrate is too steep or curved
void read_step_faces(Design& design);

/// Checks that the faces cover a point of the part.
/// \param at_mm position in the frame of the surface
/// \param point_mm position in the part frame, for the message
/// \throw InputError that names the STEP file
/// \pre the file of the faces has been read
void require_cover(const geometry::StepFace& face, const geometry::Vec2& at_mm, const geometry::Vec2& point_mm);

}  // namespace retrace::design
