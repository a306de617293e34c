#pragma once

// Averages results of single wavelengths over a spectrum.

#include <vector>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// One point traced at one wavelength, and its share of the flux.
struct SpectralPoint {
  double weight = 0.0;
  RrePoint point;
};

/// The point of the whole spectrum: means of RRE, ledger and Stokes parameters, the standard error of the mean of
/// independent estimates, all beams, the longest path. What is said of the direction is that of `at`.
RrePoint spectral_mean(const RrePoint& at, const std::vector<SpectralPoint>& points);

}  // namespace retrace::studies
