#pragma once

// Refractive index of transparent materials over wavelength, by dispersion formula, and relative to air.

#include <string>
#include <variant>
#include <vector>

namespace retrace::materials {

/// The same index at every wavelength.
struct ConstantIndex {
  double n = 1.0;
};

/// n^2 = sum over the terms of coefficient * w^exponent, w the wavelength in um.
struct PowerSeries {
  struct Term {
    double coefficient = 0.0;
    int exponent = 0;
  };
  std::vector<Term> terms;
};

/// n^2 = 1 + sum of strength * w^2 / (w^2 - resonance_um2), w in um (Sellmeier).
struct Sellmeier {
  struct Term {
    double strength = 0.0;
    double resonance_um2 = 0.0;
  };
  std::vector<Term> terms;
};

/// n = 1 + sum of strength / (resonance - w^-2), w in um (gases: Ciddor 1996).
struct GasRefractivity {
  struct Term {
    double strength_per_um2 = 0.0;
    double resonance_per_um2 = 0.0;
  };
  std::vector<Term> terms;
};

using Dispersion = std::variant<ConstantIndex, PowerSeries, Sellmeier, GasRefractivity>;

/// The refractive index by formula. \param wavelength_nm in vacuum, > 0
/// \throw InputError if the formula has no real index there
double refractive_index(const Dispersion& dispersion, double wavelength_nm);

/// A transparent material. Indices are relative to air, as polymer data are measured, unless `relative_to_vacuum`.
struct Material {
  std::string name;
  std::string description;
  Dispersion dispersion;
  bool relative_to_vacuum = false;
  double valid_from_nm = 0.0;  ///< range of the data behind the formula
  double valid_to_nm = 0.0;
  double absorption_per_mm = 0.0;  ///< Napierian, for power
  std::string source;
};

/// Index of `material` relative to `air`, at the same vacuum wavelength.
double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm);

/// True if `wavelength_nm` lies within the data behind the formula.
bool is_valid_at(const Material& material, double wavelength_nm);

}  // namespace retrace::materials
