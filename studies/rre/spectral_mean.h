#pragma once

// Averages results of single wavelengths over a spectrum.

#include <vector>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// Point at one wavelength, and its weight: the fraction of the flux that the wavelength represents.
struct SpectralPoint {
  double weight = 0.0;
  RrePoint point;
};

/// Combines the points of all wavelengths into the point of the spectrum. RRE, ledger and Stokes parameters are
/// weighted means. The standard error is that of a mean of independent estimates. Numbers of beams are added, and the
/// depth is the maximum. Data of the direction are copied from `at`.
RrePoint spectral_mean(const RrePoint& at, const std::vector<SpectralPoint>& points);

}  // namespace retrace::studies
