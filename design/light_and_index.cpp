#include "design/light_and_index.h"

#include <fmt/format.h>

#include <vector>

#include "core/number_format.h"
#include "materials/io/glass_catalogue.h"
#include "materials/io/index_record.h"
#include "materials/io/spectrum_reader.h"

namespace retrace::design {
namespace {

/// Returns the position in the file of the key that determines the wavelengths of the light.
InputLocation light_location(const Design& design) {
  return design.where(design.light.spectrum() ? "light.spectrum" : "light.wavelength_nm");
}

}  // namespace

materials::Spectrum flux_of(const Design& design) {
  using Kind = LightSpectrum::Kind;
  const LightSpectrum& light = *design.light.spectrum();
  const materials::CieTable cie = materials::shipped_cie_table();
  const materials::SpectralCurve* const efficiency = light.photopic ? &cie.photopic_efficiency : nullptr;
  switch (light.kind) {
    case Kind::illuminant_a: return materials::resolved_spectrum(cie.illuminant_a, efficiency);
    case Kind::illuminant_d65: return materials::resolved_spectrum(cie.illuminant_d65, efficiency);
    case Kind::file: return materials::resolved_spectrum(materials::read_spectral_power(light.file), efficiency);
    case Kind::lines: break;
  }
  std::vector<materials::SpectralLine> lines;
  for (const LightSpectrum::Line& line : light.lines) lines.push_back({line.wavelength_nm, line.power});
  return materials::line_spectrum(lines, efficiency);
}

materials::Material material_of(const Design& design, const materials::MaterialLibrary& library) {
  const Substance& substance = design.substance;
  const InputLocation where = design.where("body.material");
  if (!substance.catalogue) return library.find(substance.material, where);
  const auto in_catalogue = [&](const auto& read) {
    try {
      return read();
    } catch (const InputError& error) {
      // Adds the position of the key that contains the file name to the error message.
      throw InputError(design.where("body.catalogue"), error.what());
    }
  };
  if (materials::is_index_record(substance.catalogue->file))
    return in_catalogue([&] { return materials::read_index_record(substance.catalogue->file); });
  const auto catalogue = in_catalogue([&] { return materials::GlassCatalogue::read(substance.catalogue->file); });
  catalogue.require(substance.material, where);
  return in_catalogue([&] { return catalogue.glass(substance.material); });
}

void require_temperature(const Design& design, const materials::Material& material) {
  const std::optional<double>& temperature_c = design.substance.temperature_c;
  if (temperature_c && *temperature_c != material.temperature_c && !material.thermo_optic)
    throw InputError(design.where("body.temperature_c"),
                     fmt::format("must be {}, because {} has no thermo-optic coefficients, got {}",
                                 shortest(material.temperature_c), material.name, shortest(*temperature_c)));
}

double index_at_wavelength(const Design& design, const materials::Material& material, const materials::Material& air,
                           double wavelength_nm, double temperature_c) {
  try {
    return materials::index_relative_to_air(material, air, wavelength_nm, temperature_c);
  } catch (const InputError& error) {
    throw InputError(light_location(design), error.what());  // adds the position of the key of the wavelength
  }
}

double index_of_body(const Design& design, const materials::Material& material, const materials::Material& air,
                     double wavelength_nm) {
  if (design.substance.refractive_index) return *design.substance.refractive_index;
  const double index = index_at_wavelength(design, material, air, wavelength_nm,
                                           design.substance.temperature_c.value_or(material.temperature_c));
  if (!(index >= 1.0))
    throw InputError(
        design.where("body.material"),
        fmt::format("the refractive index of {} at {} nm must be >= 1, got {}", material.name, wavelength_nm, index));
  return index;
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

double index_at_centroid(const Design& design) {
  if (design.substance.refractive_index) return *design.substance.refractive_index;
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  const materials::Material material = material_of(design, library);
  require_temperature(design, material);
  return index_of_body(design, material, library.air(), wavelengths_to_trace(design).centroid_nm());
}

materials::Spectrum wavelengths_to_trace(const Design& design) {
  if (!design.light.spectrum()) return materials::monochromatic(design.light.wavelength_nm());
  const LightSpectrum& light = *design.light.spectrum();
  try {
    const materials::Spectrum flux = flux_of(design);
    return light.kind == LightSpectrum::Kind::lines ? flux : materials::traced_spectrum(flux);
  } catch (const InputError& error) {
    throw InputError(design.where("light.spectrum"),
                     error.what());  // adds the position of the key that names the file
  }
}

}  // namespace retrace::design
