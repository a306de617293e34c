#include "materials/dispersion.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace retrace::materials {
namespace {

double index_at(const ConstantIndex& d, double) {
  return d.n;
}

double index_at(const PowerSeries& d, double w_um) {
  double n2 = 0.0;
  for (const auto& term : d.terms) n2 += term.coefficient * std::pow(w_um, term.exponent);
  return std::sqrt(n2);
}

double index_at(const Sellmeier& d, double w_um) {
  double n2 = 1.0;
  for (const auto& term : d.terms) n2 += term.strength * w_um * w_um / (w_um * w_um - term.resonance_um2);
  return std::sqrt(n2);
}

double index_at(const GasRefractivity& d, double w_um) {
  double n = 1.0;
  for (const auto& term : d.terms) n += term.strength_per_um2 / (term.resonance_per_um2 - 1.0 / (w_um * w_um));
  return n;
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

bool is_valid_at(const Material& material, double wavelength_nm) {
  return wavelength_nm >= material.valid_from_nm && wavelength_nm <= material.valid_to_nm;
}

}  // namespace retrace::materials
