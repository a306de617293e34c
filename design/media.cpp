#include "design/media.h"

#include <fmt/format.h>

#include "core/number_format.h"

namespace retrace::design {

InputLocation light_location(const Design& design) {
  return design.where(design.light.spectrum() ? "light.spectrum" : "light.wavelength_nm");
}

double index_at_wavelength(const Design& design, const materials::Material& material, const materials::Material& air,
                           double wavelength_nm, double temperature_c) {
  try {
    return materials::index_relative_to_air(material, air, wavelength_nm, temperature_c);
  } catch (const InputError& error) {
    throw InputError(light_location(design), error.what());  // adds the position at which the wavelength was given
  }
}

double absorption_at(const Design& design, const Absorption& given, std::string_view key,
                     const materials::Material& material, double wavelength_nm) {
  if (std::holds_alternative<std::monostate>(given)) return materials::absorption_per_mm(material, wavelength_nm);
  if (const double* const per_mm = std::get_if<double>(&given)) return *per_mm;
  materials::SpectralCurve curve;
  for (const auto& [at_nm, per_mm] : std::get<std::vector<SpectralAbsorption>>(given)) {
    curve.wavelengths_nm.push_back(at_nm);
    curve.values.push_back(per_mm);
  }
  if (wavelength_nm < curve.wavelengths_nm.front() || wavelength_nm > curve.wavelengths_nm.back())
    throw InputError(
        design.where(key),
        fmt::format("must cover all wavelengths of the light, for example {} nm, but covers only {} to {} nm",
                    shortest(wavelength_nm), shortest(curve.wavelengths_nm.front()),
                    shortest(curve.wavelengths_nm.back())));
  return curve.at(wavelength_nm);
}

}  // namespace retrace::design
