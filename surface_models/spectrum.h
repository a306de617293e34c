#pragma once

// Power spectral densities of height maps, along an axis or averaged over directions, and the periodic waves that stand
// out of them.

#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Power spectral density over spatial frequency, 0 left out.
struct Spectrum {
  std::vector<double> frequency_per_mm;  ///< rising, evenly spaced
  /// Along an axis: one-sided, nm^2 mm; its integral over frequency is Sq^2. Radial: nm^2 mm^2; its integral over the
  /// plane of frequencies (2 pi f df) is Sq^2.
  std::vector<double> density;
};

/// The mean over all lines along `axis` of their spectra (Hann window, each line about its weighted mean; ISO 21920-2
/// and Elson and Bennett, Applied Optics 34, 201, 1995). Missing points count as the mean and the density is scaled by
/// the window that is left; lines with less than half of their points are left out. Empty if no line has 8 points.
Spectrum line_spectrum(const HeightMap& map, Axis axis);

/// The spectrum of the areal map (Hann window along both axes), averaged over directions: rings as wide as the finer
/// frequency step. Empty for a profile and for maps of fewer than 8 points along an axis.
Spectrum radial_spectrum(const HeightMap& map);

/// A line of a spectrum that stands out of its surroundings.
struct SpectralPeak {
  Axis axis = Axis::x;
  double frequency_per_mm = 0.0;
  double sq_nm = 0.0;  ///< root mean square height of the wave
};

/// Most peaks that dominant_peaks() returns.
inline constexpr std::size_t kMostPeaks = 8;

/// The lines along x and y that rise above the densities around them (three times their median, and by 35 of their
/// median deviations) and hold at least 1 % of the power of the strongest, strongest first; frequencies are
/// interpolated between the bins.
std::vector<SpectralPeak> dominant_peaks(const HeightMap& map);

/// The same for one spectrum of line_spectrum().
std::vector<SpectralPeak> peaks_of(const Spectrum& spectrum, Axis axis);

}  // namespace retrace::surface_models
