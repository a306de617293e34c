#pragma once

// Writes a tensor tree, a BRDF on a four-dimensional grid of variable resolution, as a BSDF file for the renderer
// Radiance.

#include <string>

#include "studies/appearance/tensor_tree.h"

namespace retrace::studies {

/// Returns the BSDF as XML for the programs of Radiance, on the basis LBNL/Shirley-Chiu. The BSDF is weighted by the
/// eye's response. It contains only the reflection of light that arrives from the side of the normal. The normal in
/// Radiance is the part's +z axis, and up is +y. Radiance calls this side front. The file format calls it back, because
/// it comes from the program WINDOW, which has the opposite convention.
/// \param name name of the material, on one line
std::string radiance_text(const TensorTree& tree, const std::string& name);

}  // namespace retrace::studies
