#pragma once

// Reads the dye with which the part in a picture is coloured.

#include <string>

#include "materials/spectrum.h"

namespace retrace::studies {

/// Returns the absorption coefficient of a dye per mm as a function of wavelength. The result is empty for "none".
/// \param dye "none", "red", "amber" or the path of a file
/// \throw InputError at the field `dye` if it is neither one of these names nor a readable file
materials::SpectralCurve read_dye(const std::string& dye);

}  // namespace retrace::studies
