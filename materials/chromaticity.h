#pragma once

// The colour of light: tristimulus values and chromaticity of the CIE 1931 standard observer (ISO/CIE 11664-1 and -3).

#include <array>

#include "materials/spectrum.h"

namespace retrace::materials {

/// The colour matching functions x, y and z of the observer of 2 degrees; that of y is V.
using ColourMatching = std::array<SpectralCurve, 3>;

/// X, Y and Z, in the unit of what was summed.
using Tristimulus = std::array<double, 3>;

/// Shares of X and Y in X + Y + Z.
struct Chromaticity {
  double x = 0.0;
  double y = 0.0;

  double z() const { return 1.0 - x - y; }
};

/// X, Y and Z of light of spectral power `power` (per nm, in any unit): sums over the wavelengths of the functions, as
/// the CIE takes them.
Tristimulus tristimulus(const SpectralCurve& power, const ColourMatching& functions);

/// \pre X + Y + Z > 0
Chromaticity chromaticity(const Tristimulus& values);

}  // namespace retrace::materials
