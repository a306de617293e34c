#pragma once

// Refractive index and absorption of the media of a design: of its body and of its shells.

#include <string_view>

#include "design/design.h"
#include "materials/io/material_library.h"

namespace retrace::design {

/// Returns the position of the key that determines the wavelengths of the light.
InputLocation light_location(const Design& design);

/// Returns the refractive index of a material relative to air.
/// \throw InputError at light_location() if the material or the air has no index at this wavelength
double index_at_wavelength(const Design& design, const materials::Material& material, const materials::Material& air,
                           double wavelength_nm, double temperature_c);

/// Returns the Napierian absorption coefficient of a medium, for power.
/// \param given absorption that the design specifies
/// \param key key of `given`
/// \param material material of the medium; it determines the absorption if the design specifies none
/// \throw InputError at `key` if the given curve does not cover this wavelength
double absorption_at(const Design& design, const Absorption& given, std::string_view key,
                     const materials::Material& material, double wavelength_nm);

}  // namespace retrace::design
