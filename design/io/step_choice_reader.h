#pragma once

// Reads the keys that select and place faces of a STEP file.

#include <string_view>

#include "core/schema/document.h"
#include "geometry/surface/step_face.h"

namespace retrace::design {

/// Reads the selection of faces in the table `table` of a design. Does not read the STEP file.
/// \pre the table has the key `file`
geometry::StepFace read_step_face(const schema::Document& document, std::string_view table);

}  // namespace retrace::design
