#pragma once

// Light paths in words, for people who look at them.

#include <string>

#include "raytrace/paths/light_path.h"

namespace retrace::studies {

/// What happens at an interface, a sentence.
std::string words_of(const raytrace::PathStep& step);

/// What becomes of the light of a path: "comes back after 2 total reflections".
std::string fate_of(const raytrace::LightPath& path);

}  // namespace retrace::studies
