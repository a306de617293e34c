#pragma once

// Closed forms that link rms height and scatter: phase of the reflected wave, specular share, total integrated scatter.

#include <cmath>
#include <numbers>

namespace retrace::surface_models {

/// Rms phase that a surface of rms height `sq_nm` puts on reflected light: 4 pi n s cos t / w (Bennett and Porteus, J.
/// Opt. Soc. Am. 51, 123 (1961); Davies 1954). `index` and `cos_incidence` of the side the light is on, `wavelength_nm`
/// in vacuum.
inline double reflection_phase_rad(double sq_nm, double index, double cos_incidence, double wavelength_nm) {
  return 4.0 * std::numbers::pi * index * sq_nm * cos_incidence / wavelength_nm;
}

/// Share of a lobe's power that stays specular when heights are Gaussian.
inline double specular_share_of_phase(double phase_rad) {
  return std::exp(-phase_rad * phase_rad);
}

/// Total integrated scatter: the rest.
inline double scattered_share_of_phase(double phase_rad) {
  return -std::expm1(-phase_rad * phase_rad);
}

/// Sa, the mean of |height|, of Gaussian heights of standard deviation `sq`, same unit.
inline double gaussian_sa(double sq) {
  return std::sqrt(2.0 / std::numbers::pi) * sq;
}

/// From this square of the phase on, waves of a surface act by their slopes; below, by diffraction.
inline constexpr double kSlopePhase2 = 10.0;

}  // namespace retrace::surface_models
