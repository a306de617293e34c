#pragma once

// Check of the keys that describe the state of the entrance face.

#include "core/schema/document.h"

namespace retrace::design {

/// Checks that the state of the entrance face is complete and free of contradictions.
/// \throw InputError that names file, line and key
void check_entrance_face(const schema::Document& document);

}  // namespace retrace::design
