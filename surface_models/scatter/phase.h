#pragma once

// Closed-form relations between rms height and scatter: phase of the reflected wave, specular fraction, total
// integrated scatter.

#include <cmath>
#include <numbers>

namespace retrace::surface_models {

/// Returns the rms phase of light reflected by a surface with the rms height `sq_nm`: 4 pi n s cos t / w (Bennett and
/// Porteus, J. Opt. Soc. Am. 51, 123 (1961); Davies 1954).
/// \param index index on the side of the light
/// \param cos_incidence on the side of the light
/// \param wavelength_nm in vacuum
inline double reflection_phase_rad(double sq_nm, double index, double cos_incidence, double wavelength_nm) {
  return 4.0 * std::numbers::pi * index * sq_nm * cos_incidence / wavelength_nm;
}

/// Returns the specular fraction of a lobe's power for Gaussian heights.
inline double specular_fraction_of_phase(double phase_rad) {
  return std::exp(-phase_rad * phase_rad);
}

/// Returns the total integrated scatter: 1 minus the specular fraction.
inline double scattered_fraction_of_phase(double phase_rad) {
  return -std::expm1(-phase_rad * phase_rad);
}

/// Returns Sa, the mean of |height|, of Gaussian heights with the standard deviation `sq`, in the same unit.
inline double gaussian_sa(double sq) {
  return std::sqrt(2.0 / std::numbers::pi) * sq;
}

/// Limit of the squared phase of a surface's waves. At and above this value, the waves act by their slopes; below it,
/// they act by diffraction.
inline constexpr double kSlopePhase2 = 10.0;

}  // namespace retrace::surface_models
