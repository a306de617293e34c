#pragma once

// Refractive index of transparent materials, from dispersion formulas over wavelength and temperature. Indices can be
// converted to indices relative to air.

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/warning.h"
#include "materials/spectrum.h"

namespace retrace::materials {

/// Index that is equal at all wavelengths.
struct ConstantIndex {
  double n = 1.0;
};

/// n^2 is the sum of coefficient * w^exponent over all terms, where w is the wavelength in um.
struct PowerSeries {
  struct Term {
    double coefficient = 0.0;
    int exponent = 0;
  };
  std::vector<Term> terms;
};

/// n^2 = 1 + sum of strength * w^2 / (w^2 - resonance_um2) + the terms of `power_terms`, where w is the wavelength in
/// um (Sellmeier).
struct Sellmeier {
  struct Term {
    double strength = 0.0, resonance_um2 = 0.0;
  };
  std::vector<Term> terms;
  PowerSeries power_terms = {};  ///< additional terms, which only some formulas of glass catalogues have
};

/// n = constant + by_w / w + by_w35 / w^3.5, w in um (Conrady).
struct Conrady {
  double constant = 0.0;
  double by_w = 0.0, by_w35 = 0.0;
};

/// n = constant + by_l L + by_l2 L^2 + by_w2 w^2 + by_w4 w^4 + by_w6 w^6, L = 1 / (w^2 - 0.028), w in um (Herzberger).
struct Herzberger {
  double constant = 0.0;
  double by_l = 0.0, by_l2 = 0.0;
  double by_w2 = 0.0, by_w4 = 0.0, by_w6 = 0.0;
};

/// n = 1 + sum of strength / (resonance - w^-2), w in um (gases: Ciddor 1996).
struct GasRefractivity {
  struct Term {
    double strength_per_um2 = 0.0, resonance_per_um2 = 0.0;
  };
  std::vector<Term> terms;
};

/// Dispersion formula of the refractiveindex.info database. The formulas have numbers. w is the wavelength in um and L
/// = 1 / (w^2 - 0.028). c1, c2, ... are the coefficients; missing coefficients are 0. Each sum runs over the remaining
/// coefficients, which are pairs c, c'.
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

/// Table of the index, with linear interpolation. There is no index outside the wavelengths of the table.
struct TabulatedIndex {
  SpectralCurve n;
};

using Dispersion = std::variant<ConstantIndex, PowerSeries, Sellmeier, GasRefractivity, Conrady, Herzberger,
                                RecordFormula, TabulatedIndex>;

/// Returns the refractive index at a wavelength.
/// \param wavelength_nm in vacuum, > 0
/// \throw InputError if the formula has no real index at this wavelength
double refractive_index(const Dispersion& dispersion, double wavelength_nm);

/// Coefficients of Schott's formula for the change of the index with temperature. The change of the index relative to
/// vacuum is
/// dn = (n^2 - 1) / (2 n) (d0 t + d1 t^2 + d2 t^3 + (e0 t + e1 t^2) / (w^2 - w_TK^2)),
/// where t is the temperature minus the temperature of the data, in K, and w is the wavelength in um (P. Hartmann,
/// Optical Glass, SPIE (2014), eq. 3.18).
struct ThermoOptic {
  double d0_per_k = 0.0, d1_per_k2 = 0.0, d2_per_k3 = 0.0;
  double e0_um2_per_k = 0.0, e1_um2_per_k2 = 0.0;
  double resonance_um = 0.0;  ///< w_TK
  /// temperature range of the data, if the source contains it
  double valid_from_c = -std::numeric_limits<double>::infinity();
  double valid_to_c = std::numeric_limits<double>::infinity();
  std::string source;
};

/// Returns the formula with coefficients in the order in which glass catalogues list them: d0, d1, d2, e0, e1, w_TK.
/// \pre c has at least 6 elements
inline ThermoOptic thermo_optic_of(const std::vector<double>& c, std::string source) {
  return {.d0_per_k = c[0],
          .d1_per_k2 = c[1],
          .d2_per_k3 = c[2],
          .e0_um2_per_k = c[3],
          .e1_um2_per_k2 = c[4],
          .resonance_um = c[5],
          .source = std::move(source)};
}

/// A transparent material. Its index is relative to air, as usual for polymers, unless `relative_to_vacuum` is true.
struct Material {
  std::string name;
  std::string description;
  Dispersion dispersion;
  bool relative_to_vacuum = false;
  double valid_from_nm = 0.0;  ///< range of the measured wavelengths to which the formula was fitted
  double valid_to_nm = 0.0;
  double temperature_c = 20.0;  ///< temperature of these data
  std::optional<ThermoOptic> thermo_optic;
  std::variant<double, SpectralCurve> absorption_per_mm = 0.0;  ///< Napierian, for power
  std::string source;
  Warnings warnings = {};  ///< Doubts about the data, each with its file and line.
};

/// Returns the index of `material` relative to `air` at the same vacuum wavelength, at the temperature of the data.
double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm);

/// Returns the index of `material` relative to `air` when both are at `temperature_c`. At constant pressure, n - 1 of
/// air is proportional to 1 / (1 + 0.00367 T), with T in degrees C (Hartmann 2014, eq. 3.21).
/// \throw InputError if the index is not real, or if the material has no thermo-optic coefficients and `temperature_c`
///     is not the temperature of its data
double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm, double temperature_c);

/// Returns the absorption coefficient per mm at a wavelength. Curves are interpolated linearly; outside their
/// wavelengths, the value at the nearest end is used.
double absorption_per_mm(const Material& material, double wavelength_nm);

/// Compares the formula's index at the helium d line (587.56 nm) with `stated_nd`, the value that a data file states
/// next to the formula. Returns a text that describes the contradiction. Returns an empty text if the two values agree
/// within 1e-3, if `stated_nd` is a placeholder (1 or less), or if the data do not include the d line.
std::string nd_contradiction(const Material& material, double stated_nd);

/// Returns true if `wavelength_nm` is within the range of the data.
bool is_valid_at(const Material& material, double wavelength_nm);

}  // namespace retrace::materials
