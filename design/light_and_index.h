#pragma once

// Wavelengths of the light of a design, and the material, refractive index and absorption of its body and shells.

#include <string_view>

#include "design/design.h"
#include "materials/io/material_library.h"
#include "materials/spectrum.h"

namespace retrace::design {

/// Returns the material of the part. It is a glass of the design's catalogue, the material of an index record, or a
/// material of the shipped library.
/// \throw InputError that names file, line and key, if the material is unknown
materials::Material material_of(const Design& design, const materials::MaterialLibrary& library);

/// Checks that the data of a material are valid at the temperature of the design.
/// \throw InputError at `body.temperature_c` if they are not valid at this temperature
void require_temperature(const Design& design, const materials::Material& material);

/// Returns the refractive index of a material relative to air.
/// \throw InputError at the key of the wavelength, if the material has no data at this wavelength
double index_at_wavelength(const Design& design, const materials::Material& material, const materials::Material& air,
                           double wavelength_nm, double temperature_c);

/// Returns the refractive index of the body relative to air.
/// \param material result of material_of()
/// \throw InputError if the material has no data at this wavelength, or if the index is less than 1
double index_of_body(const Design& design, const materials::Material& material, const materials::Material& air,
                     double wavelength_nm);

/// Returns the Napierian absorption coefficient of a medium for power, per mm.
/// \param given absorption that the design specifies for the medium
/// \param key key of `given`, for error messages
/// \param material material of the medium; its absorption is used if the design specifies none
/// \throw InputError at `key` if the given curve does not contain this wavelength
double absorption_at(const Design& design, const Absorption& given, std::string_view key,
                     const materials::Material& material, double wavelength_nm);

/// Returns the spectral flux of the lamp or of the spectral lines, before representative wavelengths are selected.
/// \pre the light of the design is a spectrum
/// \throw InputError if the spectrum is not valid
materials::Spectrum flux_of(const Design& design);

/// Returns the wavelengths to trace: all spectral lines of the design, or a few wavelengths that represent its lamp.
/// \throw InputError at `light.spectrum` if a spectrum is not valid
materials::Spectrum wavelengths_to_trace(const Design& design);

/// Returns the refractive index of the body relative to air at the wavelength of the light. If the light is a spectrum,
/// the index at its centroid is returned.
/// \throw InputError if the material or the spectrum cannot be determined
double index_at_centroid(const Design& design);

}  // namespace retrace::design
