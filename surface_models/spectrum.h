#pragma once

// Power spectral densities of height maps, along an axis or averaged over directions. Finds dominant periodic waves.

#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Power spectral density over spatial frequency. The frequency 0 is omitted.
struct Spectrum {
  std::vector<double> frequency_per_mm;  ///< ascending, evenly spaced
  /// Along an axis, the density is one-sided in nm^2 mm, and its integral over frequency is Sq^2. A radial density is
  /// in nm^2 mm^2, and its integral over the plane of frequencies (2 pi f df) is Sq^2.
  std::vector<double> density;
};

/// Returns the mean of the spectra of all lines along `axis`. A Hann window is applied, after the weighted mean of each
/// line was subtracted (ISO 21920-2; Elson and Bennett, Applied Optics 34, 201, 1995). Missing points are replaced by
/// the mean, and the density is divided by the sum of the squared window at the measured points. Lines with less than
/// half of their points are omitted. The result is empty if no line has 8 points.
Spectrum line_spectrum(const HeightMap& map, Axis axis);

/// Returns the spectrum of an areal map, averaged over directions, with a Hann window along both axes. The rings are as
/// wide as the finer of the two frequency steps. The result is empty for a profile and for maps with fewer than 8
/// points along an axis.
Spectrum radial_spectrum(const HeightMap& map);

/// Peak of a spectrum above its surroundings.
struct SpectralPeak {
  Axis axis = Axis::x;
  double frequency_per_mm = 0.0;
  double sq_nm = 0.0;  ///< root mean square height of the wave
};

/// Maximum number of peaks that dominant_peaks() returns.
inline constexpr std::size_t kMaxPeaks = 8;

/// Returns the peaks along x and y, strongest first. The density of a peak must be above three times the median of the
/// densities around it. It must also exceed this median by 35 median deviations, and have at least 1 % of the power of
/// the strongest peak. Frequencies are interpolated between the bins.
std::vector<SpectralPeak> dominant_peaks(const HeightMap& map);

/// Returns the peaks of a single spectrum from line_spectrum(), by the criteria of dominant_peaks().
std::vector<SpectralPeak> peaks_of(const Spectrum& spectrum, Axis axis);

}  // namespace retrace::surface_models
