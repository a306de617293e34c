#pragma once

// Refractive index of transparent materials over wavelength and temperature, by dispersion formula, and relative to
// air.

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/warning.h"
#include "materials/spectrum.h"

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

/// n^2 = 1 + sum of strength * w^2 / (w^2 - resonance_um2) + the terms of `rest`, w in um (Sellmeier).
struct Sellmeier {
  struct Term {
    double strength = 0.0;
    double resonance_um2 = 0.0;
  };
  std::vector<Term> terms;
  PowerSeries rest = {};  ///< none but in variants of glass catalogues
};

/// n = constant + by_w / w + by_w35 / w^3.5, w in um (Conrady).
struct Conrady {
  double constant = 0.0;
  double by_w = 0.0;
  double by_w35 = 0.0;
};

/// n = constant + by_l L + by_l2 L^2 + by_w2 w^2 + by_w4 w^4 + by_w6 w^6, L = 1 / (w^2 - 0.028), w in um (Herzberger).
struct Herzberger {
  double constant = 0.0;
  double by_l = 0.0;
  double by_l2 = 0.0;
  double by_w2 = 0.0;
  double by_w4 = 0.0;
  double by_w6 = 0.0;
};

/// n = 1 + sum of strength / (resonance - w^-2), w in um (gases: Ciddor 1996).
struct GasRefractivity {
  struct Term {
    double strength_per_um2 = 0.0;
    double resonance_per_um2 = 0.0;
  };
  std::vector<Term> terms;
};

/// A dispersion formula of the refractiveindex.info database. Each formula has a number; w is the wavelength in um and
/// L = 1 / (w^2 - 0.028). Sums run over all further pairs of coefficients, c and c'. Missing coefficients are 0.
/// 1: n^2 - 1 = c1 + sum of c w^2 / (w^2 - c'^2)
/// 2: n^2 - 1 = c1 + sum of c w^2 / (w^2 - c')
/// 3: n^2 = c1 + sum of c w^c'
/// 4: n^2 = c1 + c2 w^c3 / (w^2 - c4^c5) + c6 w^c7 / (w^2 - c8^c9) + sum of c w^c'
/// 5: n = c1 + sum of c w^c'
/// 6: n - 1 = c1 + sum of c / (c' - w^-2)
/// 7: n = c1 + c2 L + c3 L^2 + c4 w^2 + c5 w^4 + c6 w^6
/// 8: (n^2 - 1) / (n^2 + 2) = c1 + c2 w^2 / (w^2 - c3) + c4 w^2
/// 9: n^2 = c1 + c2 / (w^2 - c3) + c4 (w - c5) / ((w - c5)^2 + c6)
/// Source: M. N. Polyanskiy, Refractiveindex.info database of optical constants, Sci. Data 11, 94 (2024), "Dispersion
/// formulas".
struct RecordFormula {
  int number = 2;
  std::vector<double> c;  ///< c1 first
};

/// Linear between its wavelengths; none beyond them.
struct TabulatedIndex {
  SpectralCurve n;
};

using Dispersion = std::variant<ConstantIndex, PowerSeries, Sellmeier, GasRefractivity, Conrady, Herzberger,
                                RecordFormula, TabulatedIndex>;

/// The refractive index by formula. \param wavelength_nm in vacuum, > 0
/// \throw InputError if the formula has no real index there
double refractive_index(const Dispersion& dispersion, double wavelength_nm);

/// How the index against vacuum changes when a material is warmer by t than its data are for (Schott's formula):
/// dn = (n^2 - 1) / (2 n) (d0 t + d1 t^2 + d2 t^3 + (e0 t + e1 t^2) / (w^2 - w_TK^2)), w in um.
/// P. Hartmann, Optical Glass, SPIE (2014), eq. 3.18.
struct ThermoOptic {
  double d0_per_k = 0.0;
  double d1_per_k2 = 0.0;
  double d2_per_k3 = 0.0;
  double e0_um2_per_k = 0.0;
  double e1_um2_per_k2 = 0.0;
  double resonance_um = 0.0;                                       ///< w_TK
  double valid_from_c = -std::numeric_limits<double>::infinity();  ///< range of the data, where the source tells it
  double valid_to_c = std::numeric_limits<double>::infinity();
  std::string source;
};

/// A transparent material. Indices are relative to air, as polymer data are measured, unless `relative_to_vacuum`.
struct Material {
  std::string name;
  std::string description;
  Dispersion dispersion;
  bool relative_to_vacuum = false;
  double valid_from_nm = 0.0;  ///< range of the data behind the formula
  double valid_to_nm = 0.0;
  double temperature_c = 20.0;  ///< that the data behind the formula are for
  std::optional<ThermoOptic> thermo_optic;
  std::variant<double, SpectralCurve> absorption_per_mm = 0.0;  ///< Napierian, for power
  std::string source;
  Warnings warnings = {};  ///< Doubts about the data, each with its file and line.
};

/// Index of `material` relative to `air`, at the same vacuum wavelength, at the temperature that its data are for.
double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm);

/// The same where material and air are at `temperature_c`; of the air n - 1 goes as 1 / (1 + 0.00367 T), T in degrees
/// C, at constant pressure (Hartmann 2014, eq. 3.21). \throw InputError if that is not the temperature of the data and
/// the material has no thermo-optic coefficients, or there is no real index
double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm, double temperature_c);

/// What is lost per mm at a wavelength: of a curve linear between its wavelengths, beyond them as at its ends.
double absorption_per_mm(const Material& material, double wavelength_nm);

/// Compares the index at the d line of helium with `stated_nd`, the value that a data file states next to its formula.
/// Returns what is wrong. Returns an empty text if the two agree within 1e-3, if `stated_nd` is a placeholder (1 or
/// less), or if the data do not reach the d line.
std::string doubt_of_nd(const Material& material, double stated_nd);

/// True if `wavelength_nm` lies within the data behind the formula.
bool is_valid_at(const Material& material, double wavelength_nm);

}  // namespace retrace::materials
