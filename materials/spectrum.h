#pragma once

// Light with many wavelengths. Spectra of lamps are weighted by the response of the eye. A few wavelengths, chosen by
// Gauss quadrature, are traced instead of the complete spectrum.

#include <cstddef>
#include <vector>

namespace retrace::materials {

/// Quantity as a function of wavelength. It is linear between its samples and 0 outside them.
struct SpectralCurve {
  std::vector<double> wavelengths_nm;  ///< in vacuum, ascending
  std::vector<double> values;          ///< >= 0, one per wavelength

  double at(double wavelength_nm) const;
};

/// Spectral line of a lamp.
struct SpectralLine {
  double wavelength_nm = 0.0;  ///< in vacuum
  double power = 0.0;          ///< in any unit, >= 0
};

/// Wavelengths, and the fraction of the flux that each represents.
struct Spectrum {
  std::vector<double> wavelengths_nm;  ///< in vacuum, ascending
  std::vector<double> weights;         ///< > 0, one per wavelength; the sum is 1

  std::size_t size() const { return wavelengths_nm.size(); }
  double centroid_nm() const;
};

/// Returns the spectrum of light with a single wavelength.
Spectrum monochromatic(double wavelength_nm);

/// Returns the flux of a lamp as a spectrum with many wavelengths. The lamp has the spectral power `power` (per nm, in
/// any unit). The trapezium rule is used at the wavelengths of `power` and at all multiples of 5 nm between them.
/// \param efficiency V for luminous flux; null for radiant flux
/// \throw InputError if the flux is 0
Spectrum resolved_spectrum(const SpectralCurve& power, const SpectralCurve* efficiency);

/// Returns the flux of a lamp with separate spectral lines as a spectrum. Lines without flux are omitted.
/// \pre wavelengths are in ascending order
/// \throw InputError if the flux is 0
Spectrum line_spectrum(const std::vector<SpectralLine>& lines, const SpectralCurve* efficiency);

/// Returns a Gauss rule: a spectrum with only `nodes` wavelengths that gives the same means as `spectrum` for
/// polynomials in the wavelength up to the degree 2 * nodes - 1. Returns the spectrum itself if it has at most `nodes`
/// wavelengths.
/// The recurrence coefficients are computed by the procedure of Stieltjes. Nodes and weights follow from the
/// eigenvalues of the Jacobi matrix (Golub and Welsch, Math. Comp. 23, 221 (1969); Gautschi, Orthogonal Polynomials
/// (2004), 2.2.3.1).
/// \pre nodes > 0
Spectrum gauss_rule(const Spectrum& spectrum, std::size_t nodes);

/// Number of spans of equal flux into which the spectrum of a lamp is divided. The remaining error is given in
/// docs/theory/spectra.md.
inline constexpr std::size_t kSpectralParts = 5;

/// Returns the wavelengths to trace. The spectrum is divided into `parts` spans of equal flux, and each span has a
/// Gauss rule with two wavelengths. No wavelength then represents a large fraction of the flux near a kink or a jump of
/// a property. Returns the spectrum itself if it has at most 2 * parts wavelengths.
/// \pre parts > 0
Spectrum traced_spectrum(const Spectrum& spectrum, std::size_t parts = kSpectralParts);

}  // namespace retrace::materials
