#pragma once

// Averages results of single wavelengths over a spectrum.

#include <vector>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// Point at one wavelength, and the fraction of the flux that it represents.
struct SpectralPoint {
  double weight = 0.0;
  RrePoint point;
};

/// Returns the point of the whole spectrum. RRE, ledger and Stokes parameters are means. The standard error is that of
/// the mean of independent estimates. Beams are added up, and the depth is the maximum. Data of the direction are those
/// of `at`.
RrePoint spectral_mean(const RrePoint& at, const std::vector<SpectralPoint>& points);

}  // namespace retrace::studies
