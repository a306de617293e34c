#include "materials/dispersion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/number_format.h"
#include "core/overloaded.h"

namespace retrace::materials {
namespace {

double index_at(const ConstantIndex& d, double) {
  return d.n;
}

double sum_of(const PowerSeries& d, double w_um) {
  double sum = 0.0;
  for (const auto& term : d.terms) sum += term.coefficient * std::pow(w_um, term.exponent);
  return sum;
}

double index_at(const PowerSeries& d, double w_um) {
  return std::sqrt(sum_of(d, w_um));
}

double index_at(const Sellmeier& d, double w_um) {
  double n2 = 1.0;
  for (const auto& term : d.terms) n2 += term.strength * w_um * w_um / (w_um * w_um - term.resonance_um2);
  return std::sqrt(n2 + sum_of(d.rest, w_um));
}

double index_at(const Conrady& d, double w_um) {
  return d.constant + d.by_w / w_um + d.by_w35 / std::pow(w_um, 3.5);
}

double index_at(const Herzberger& d, double w_um) {
  const double w2 = w_um * w_um;
  const double l = 1.0 / (w2 - 0.028);
  return d.constant + (d.by_l + d.by_l2 * l) * l + (d.by_w2 + (d.by_w4 + d.by_w6 * w2) * w2) * w2;
}

double index_at(const GasRefractivity& d, double w_um) {
  double n = 1.0;
  for (const auto& term : d.terms) n += term.strength_per_um2 / (term.resonance_per_um2 - 1.0 / (w_um * w_um));
  return n;
}

/// By how much the index against vacuum grows. \param n at the temperature of the data, relative to air
double growth_of_index(const ThermoOptic& t, double n, double w_um, double warmer_k) {
  const double by_wavelength =
      (t.e0_um2_per_k + t.e1_um2_per_k2 * warmer_k) / (w_um * w_um - t.resonance_um * t.resonance_um);
  const double per_k = t.d0_per_k + (t.d1_per_k2 + t.d2_per_k3 * warmer_k) * warmer_k + by_wavelength;
  return 0.5 * (n * n - 1.0) / n * per_k * warmer_k;
}

/// Index of air against vacuum at a temperature of its own.
double index_of_air(const Material& air, double wavelength_nm, double temperature_c) {
  constexpr double expansion_per_c = 0.00367;
  return 1.0 + (refractive_index(air.dispersion, wavelength_nm) - 1.0) * (1.0 + expansion_per_c * air.temperature_c) /
                   (1.0 + expansion_per_c * temperature_c);
}

}  // namespace

double refractive_index(const Dispersion& dispersion, double wavelength_nm) {
  const double n = std::visit([&](const auto& d) { return index_at(d, 1e-3 * wavelength_nm); }, dispersion);
  if (!std::isfinite(n)) throw InputError(fmt::format("the dispersion formula has no index at {} nm", wavelength_nm));
  return n;
}

double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm) {
  const double n = refractive_index(material.dispersion, wavelength_nm);
  return material.relative_to_vacuum ? n / refractive_index(air.dispersion, wavelength_nm) : n;
}

double index_relative_to_air(const Material& material, const Material& air, double wavelength_nm,
                             double temperature_c) {
  const double n = index_relative_to_air(material, air, wavelength_nm);
  if (temperature_c == material.temperature_c) return n;
  if (!material.thermo_optic)
    throw InputError(fmt::format("{} has no thermo-optic coefficients, so its index is known at {} C alone, got {} C",
                                 material.name, shortest(material.temperature_c), shortest(temperature_c)));
  const double grown =
      growth_of_index(*material.thermo_optic, n, 1e-3 * wavelength_nm, temperature_c - material.temperature_c);
  const double warm = (n * index_of_air(air, wavelength_nm, material.temperature_c) + grown) /
                      index_of_air(air, wavelength_nm, temperature_c);
  if (!std::isfinite(warm))
    throw InputError(fmt::format("the thermo-optic formula has no index at {} nm and {} C", shortest(wavelength_nm),
                                 shortest(temperature_c)));
  return warm;
}

double absorption_per_mm(const Material& material, double wavelength_nm) {
  return std::visit(Overloaded{[](double per_mm) { return per_mm; },
                               [&](const SpectralCurve& curve) {
                                 return curve.at(std::clamp(wavelength_nm, curve.wavelengths_nm.front(),
                                                            curve.wavelengths_nm.back()));
                               }},
                    material.absorption_per_mm);
}

bool is_valid_at(const Material& material, double wavelength_nm) {
  return wavelength_nm >= material.valid_from_nm && wavelength_nm <= material.valid_to_nm;
}

}  // namespace retrace::materials
