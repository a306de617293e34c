#pragma once

// Tensor tree as a BSDF file of Radiance.

#include <string>

#include "studies/appearance/tensor_tree.h"

namespace retrace::studies {

/// Returns the BSDF as XML for the programs of Radiance, on the basis LBNL/Shirley-Chiu. It contains the reflection of
/// light from the side of the normal, weighted by the eye's response. The normal in Radiance is the part's +z axis, and
/// up is +y. Radiance calls this side front, but the file format, which comes from WINDOW, calls it back.
/// \param name name of the material, on one line
std::string radiance_text(const TensorTree& tree, const std::string& name);

}  // namespace retrace::studies
