#pragma once

// Fitted lobes as a function in GLSL.

#include <string>
#include <vector>

#include "studies/appearance/lobes.h"

namespace retrace::studies {

/// Returns constants and the function `vec3 retrace_brdf(vec3 to_source, vec3 to_observer)`, in GLSL 3.30 and ES 3.00.
/// \param remarks lines of the comment in the file
std::string glsl_text(const ReflectionLobes& lobes, const std::vector<std::string>& remarks);

}  // namespace retrace::studies
