#include "materials/metal.h"

namespace retrace::materials {

std::complex<double> complex_index(const LorentzDrude& model, double wavelength_nm) {
  constexpr double kPhotonEvNm = 1239.8419843320026;  // h c / e, exact in the SI since 2019
  const double w = kPhotonEvNm / wavelength_nm;
  std::complex<double> permittivity = 1.0;
  for (const LorentzDrude::Term& term : model.terms)
    permittivity += term.strength * model.plasma_ev * model.plasma_ev /
                    std::complex<double>(term.resonance_ev * term.resonance_ev - w * w, -w * term.damping_ev);
  return std::sqrt(permittivity);
}

}  // namespace retrace::materials
