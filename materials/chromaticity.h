#pragma once

// Colour of light: tristimulus values and chromaticity for the CIE 1931 standard observer (ISO/CIE 11664-1 and -3).

#include <array>

#include "materials/spectrum.h"

namespace retrace::materials {

/// Colour matching functions x, y and z of the 2-degree observer. The function y equals V.
using ColourMatching = std::array<SpectralCurve, 3>;

/// X, Y and Z, in the unit of the spectral power.
using Tristimulus = std::array<double, 3>;

/// Chromaticity coordinates: X and Y divided by X + Y + Z.
struct Chromaticity {
  double x = 0.0;
  double y = 0.0;

  double z() const { return 1.0 - x - y; }
};

/// Returns X, Y and Z of light with the spectral power `power` (per nm, in any unit). As defined by the CIE, these are
/// sums over the wavelengths at which the colour matching functions are tabulated.
Tristimulus tristimulus(const SpectralCurve& power, const ColourMatching& functions);

/// Returns the chromaticity of tristimulus values.
/// \pre X + Y + Z > 0
Chromaticity chromaticity(const Tristimulus& values);

}  // namespace retrace::materials
