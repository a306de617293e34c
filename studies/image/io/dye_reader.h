#pragma once

// Reads the dye of a part in a picture.

#include <string>

#include "materials/spectrum.h"

namespace retrace::studies {

/// Returns the spectral absorption of a dye per mm. Empty for "none".
/// \param dye "none", "red", "amber" or the path of a file
/// \throw InputError at the field `dye` if it is neither a known name nor a readable file
materials::SpectralCurve read_dye(const std::string& dye);

}  // namespace retrace::studies
