#pragma once

// Describes light paths in words for the user.

#include <string>

#include "raytrace/paths/light_path.h"

namespace retrace::studies {

/// Returns a sentence about what happens at an interface.
std::string description_of(const raytrace::PathStep& step);

/// Returns a description of the end of a path, such as "comes back after 2 total reflections".
std::string ending_text(const raytrace::LightPath& path);

}  // namespace retrace::studies
