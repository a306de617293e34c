#pragma once

// Light of many wavelengths: spectra of lamps weighted by the eye, and the few wavelengths, by Gauss quadrature, that
// are traced in their place.

#include <cstddef>
#include <vector>

namespace retrace::materials {

/// A quantity over wavelength: linear between its samples, 0 outside them.
struct SpectralCurve {
  std::vector<double> wavelengths_nm;  ///< in vacuum, ascending
  std::vector<double> values;          ///< >= 0, as many

  double at(double wavelength_nm) const;
};

/// A line of a lamp.
struct SpectralLine {
  double wavelength_nm = 0.0;  ///< in vacuum
  double power = 0.0;          ///< in any unit, >= 0
};

/// Wavelengths and the share of the flux that each stands for.
struct Spectrum {
  std::vector<double> wavelengths_nm;  ///< in vacuum, ascending
  std::vector<double> weights;         ///< > 0, as many; they add to 1

  std::size_t size() const { return wavelengths_nm.size(); }
  double centroid_nm() const;
};

/// Light of one wavelength.
Spectrum monochromatic(double wavelength_nm);

/// Flux of a lamp of spectral power `power` (per nm, in any unit) by the trapezium rule, at its own wavelengths and all
/// multiples of 5 nm between them. \param efficiency V for luminous flux; null for radiant flux
/// \throw InputError if no flux is left
Spectrum resolved_spectrum(const SpectralCurve& power, const SpectralCurve* efficiency);

/// The same for a lamp of separate lines, each of which is kept unless it carries nothing.
/// \pre wavelengths ascend \throw InputError if no flux is left
Spectrum line_spectrum(const std::vector<SpectralLine>& lines, const SpectralCurve* efficiency);

/// The Gauss rule of `nodes` wavelengths for means over `spectrum`, exact for polynomials in the wavelength of degree
/// 2 nodes - 1: recurrence coefficients by the procedure of Stieltjes, nodes and weights from the eigenvalues of the
/// Jacobi matrix (Golub and Welsch, Math. Comp. 23, 221 (1969); Gautschi, Orthogonal Polynomials (2004), 2.2.3.1).
/// The spectrum itself if it has no more wavelengths than that. \pre nodes > 0
Spectrum gauss_rule(const Spectrum& spectrum, std::size_t nodes);

/// Parts of equal flux into which a lamp is divided: docs/theory/spectra.md says what error they leave.
inline constexpr std::size_t kSpectralParts = 5;

/// The wavelengths to trace: two for each of `parts` spans of wavelength that carry the same flux, by the Gauss rule of
/// the span, so that no node stands for much of the light where a property has a kink or a jump. The spectrum itself if
/// it has no more wavelengths than that. \pre parts > 0
Spectrum traced_spectrum(const Spectrum& spectrum, std::size_t parts = kSpectralParts);

}  // namespace retrace::materials
