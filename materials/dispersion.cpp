#include "materials/dispersion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  return std::sqrt(n2 + sum_of(d.power_terms, w_um));
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

double index_at(const RecordFormula& d, double w_um) {
  const auto c = [&](std::size_t k) { return k <= d.c.size() ? d.c[k - 1] : 0.0; };  // coefficients are counted from 1
  const double w2 = w_um * w_um;
  /// Sum of term(c, c') over the pairs of coefficients from number `first` on.
  const auto sum = [&](std::size_t first, const auto& term) {
    double total = 0.0;
    for (std::size_t k = first; k <= d.c.size(); k += 2)
      if (c(k) != 0.0) total += term(c(k), c(k + 1));
    return total;
  };
  const auto power = [&](double factor, double exponent) { return factor * std::pow(w_um, exponent); };
  const auto resonance = [&](std::size_t first) {
    return c(first) == 0.0 ? 0.0 : power(c(first), c(first + 1)) / (w2 - std::pow(c(first + 2), c(first + 3)));
  };
  switch (d.number) {
    case 1: return std::sqrt(1.0 + c(1) + sum(2, [&](double a, double b) { return a * w2 / (w2 - b * b); }));
    case 2: return std::sqrt(1.0 + c(1) + sum(2, [&](double a, double b) { return a * w2 / (w2 - b); }));
    case 3: return std::sqrt(c(1) + sum(2, power));
    case 4: return std::sqrt(c(1) + resonance(2) + resonance(6) + sum(10, power));
    case 5: return c(1) + sum(2, power);
    case 6: return 1.0 + c(1) + sum(2, [&](double a, double b) { return a / (b - 1.0 / w2); });
    case 7: return index_at(Herzberger{c(1), c(2), c(3), c(4), c(5), c(6)}, w_um);
    case 8: {
      const double y = c(1) + (c(2) == 0.0 ? 0.0 : c(2) * w2 / (w2 - c(3))) + c(4) * w2;
      return std::sqrt((1.0 + 2.0 * y) / (1.0 - y));
    }
    default: {
      const double w = w_um - c(5);
      return std::sqrt(c(1) + (c(2) == 0.0 ? 0.0 : c(2) / (w2 - c(3))) +
                       (c(4) == 0.0 ? 0.0 : c(4) * w / (w * w + c(6))));
    }
  }
}

double index_at(const TabulatedIndex& d, double w_um) {
  const double wavelength_nm = 1e3 * w_um;
  const bool is_within = wavelength_nm >= d.n.wavelengths_nm.front() && wavelength_nm <= d.n.wavelengths_nm.back();
  return is_within ? d.n.at(wavelength_nm) : std::numeric_limits<double>::quiet_NaN();
}

/// Returns the increase of the index relative to vacuum when the material is warmer by `warmer_k`.
/// \param n index relative to air at the temperature of the data
double growth_of_index(const ThermoOptic& t, double n, double w_um, double warmer_k) {
  const double by_wavelength =
      (t.e0_um2_per_k + t.e1_um2_per_k2 * warmer_k) / (w_um * w_um - t.resonance_um * t.resonance_um);
  const double per_k = t.d0_per_k + (t.d1_per_k2 + t.d2_per_k3 * warmer_k) * warmer_k + by_wavelength;
  return 0.5 * (n * n - 1.0) / n * per_k * warmer_k;
}

/// Returns the index of air relative to vacuum at a given temperature.
double index_of_air(const Material& air, double wavelength_nm, double temperature_c) {
  constexpr double expansion_per_c = 0.00367;
  return 1.0 + (refractive_index(air.dispersion, wavelength_nm) - 1.0) * (1.0 + expansion_per_c * air.temperature_c) /
                   (1.0 + expansion_per_c * temperature_c);
}

}  // namespace

double refractive_index(const Dispersion& dispersion, double wavelength_nm) {
  const double n = std::visit([&](const auto& d) { return index_at(d, 1e-3 * wavelength_nm); }, dispersion);
  if (std::isfinite(n)) return n;
  if (const auto* const table = std::get_if<TabulatedIndex>(&dispersion))
    throw InputError(fmt::format("the table of the refractive index covers {} to {} nm, got {} nm",
                                 shortest(table->n.wavelengths_nm.front()), shortest(table->n.wavelengths_nm.back()),
                                 shortest(wavelength_nm)));
  throw InputError(fmt::format("the dispersion formula gives no refractive index at {} nm", wavelength_nm));
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
    throw InputError(fmt::format("{} has no thermo-optic coefficients, so its index is known only at {} C, got {} C",
                                 material.name, shortest(material.temperature_c), shortest(temperature_c)));
  const double grown =
      growth_of_index(*material.thermo_optic, n, 1e-3 * wavelength_nm, temperature_c - material.temperature_c);
  const double warm = (n * index_of_air(air, wavelength_nm, material.temperature_c) + grown) /
                      index_of_air(air, wavelength_nm, temperature_c);
  if (!std::isfinite(warm))
    throw InputError(fmt::format("the thermo-optic formula gives no refractive index at {} nm and {} C",
                                 shortest(wavelength_nm), shortest(temperature_c)));
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

std::string nd_contradiction(const Material& material, double stated_nd) {
  constexpr double d_line_nm = 587.5618;
  constexpr double max_difference = 1e-3;
  if (!(stated_nd > 1.0) || !is_valid_at(material, d_line_nm)) return {};
  std::string computed;
  try {
    const double n = refractive_index(material.dispersion, d_line_nm);
    if (std::abs(n - stated_nd) <= max_difference) return {};
    computed = fixed(n, 6);
  } catch (const InputError&) {
    computed = "no index";
  }
  return fmt::format(
      "n_d must be within 0.001 of the formula's index at 587.56 nm ({}), got {}; check the coefficients", computed,
      shortest(stated_nd));
}

bool is_valid_at(const Material& material, double wavelength_nm) {
  return wavelength_nm >= material.valid_from_nm && wavelength_nm <= material.valid_to_nm;
}

}  // namespace retrace::materials
