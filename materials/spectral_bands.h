#pragma once

// Bands of a lamp's spectrum. Each traced wavelength represents one band.

#include <vector>

#include "materials/spectrum.h"

namespace retrace::materials {

/// Divides a spectrum into bands, one for each traced wavelength. The flux of a band is the weight of its wavelength.
/// Each band is returned as 65 wavelengths, which divide it into 64 intervals of equal flux.
/// \param traced wavelengths and their weights, whose sum may differ from 1
/// \param flux spectrum with many wavelengths
/// \pre both spectra have at least one wavelength
std::vector<std::vector<double>> spectral_bands(const Spectrum& traced, const Spectrum& flux);

}  // namespace retrace::materials
