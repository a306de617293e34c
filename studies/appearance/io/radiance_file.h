#pragma once

// A tensor tree as a BSDF file of Radiance.

#include <string>

#include "studies/appearance/tensor_tree.h"

namespace retrace::studies {

/// XML as Radiance's programs read it: the reflection of light from the side of the normal, weighed by the eye, on the
/// basis LBNL/Shirley-Chiu. Their normal is the part's +z, their up its +y. Radiance calls that side front and the
/// format, after WINDOW, back. \param name one line
std::string radiance_text(const TensorTree& tree, const std::string& name);

}  // namespace retrace::studies
