#pragma once

// Computes wavelengths and weights for the mean of a property over the spectrum of a lamp, if the property has knees. A
// knee is a wavelength near which the property changes like the square root of the distance from the knee. An example
// is the reflectance where total reflection begins or ends.

#include <cstddef>
#include <vector>

#include "materials/spectrum.h"

namespace retrace::materials {

/// Returns the wavelengths to trace and their weights. The spectrum is split into intervals at the knees. Within an
/// interval, the integration variable of the Gauss rules is chosen such that the property is a smooth function of it
/// (docs/theory/spectra.md). For properties without knees, traced_spectrum() is used instead.
/// \param power spectral power of the lamp, per nm, in any unit
/// \param efficiency spectral response of the receiver
/// \param parts approximate number of Gauss rules, each with two wavelengths; every interval has at least one rule
/// \param knees_nm wavelengths of the knees, ascending; knees outside the lamp's spectrum are ignored
/// \throw InputError if the lamp has no power at wavelengths to which the receiver responds
Spectrum knee_rule(const SpectralCurve& power, const SpectralCurve& efficiency, std::size_t parts,
                   const std::vector<double>& knees_nm);

}  // namespace retrace::materials
