#pragma once

// Complex refractive index of metals from the Lorentz-Drude model, for aluminised facets.

#include <complex>
#include <string>
#include <vector>

namespace retrace::materials {

/// Dielectric function of a metal by the Lorentz-Drude model:
/// eps = 1 - f0 wp^2 / (w (w + i g0)) + sum of f wp^2 / (e^2 - w^2 - i w g), where all quantities are photon energies
/// in eV.
/// Rakic et al., Applied Optics 37, 5271 (1998), eqs. 1 to 3.
struct LorentzDrude {
  struct Term {
    double strength = 0.0;
    double damping_ev = 0.0;
    double resonance_ev = 0.0;  ///< resonance energy; 0 for the term of the free electrons
  };
  double plasma_ev = 0.0;
  std::vector<Term> terms;
};

/// An opaque metal film.
struct Metal {
  std::string name;
  std::string description;
  LorentzDrude model;
  double valid_from_nm = 0.0;  ///< range of the data from which the model was fitted
  double valid_to_nm = 0.0;
  std::string source;
};

/// Returns n + i k relative to vacuum, with k > 0 (time dependence exp(-i w t)).
/// \param wavelength_nm in vacuum, > 0
std::complex<double> complex_index(const LorentzDrude& model, double wavelength_nm);

}  // namespace retrace::materials
