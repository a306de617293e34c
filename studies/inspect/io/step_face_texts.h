#pragma once

// Text and JSON about the STEP files of a design, for `retrace inspect`.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/design.h"

namespace retrace::studies {

/// Returns the lines of the report about faces of STEP files that are the entrance surface or the substrate: unit,
/// measured deviation, closed gaps and tangent breaks. Returns an empty text if the design has no such faces.
std::string step_faces_text(const design::Design& design);

/// Adds the member `step` to the objects `entrance_surface` and `substrate` of a report if they are faces of STEP
/// files.
void add_step_faces(const design::Design& design, nlohmann::ordered_json& json);

}  // namespace retrace::studies
