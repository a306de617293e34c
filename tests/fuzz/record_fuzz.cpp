// Reads any bytes as a record of refractiveindex.info. The record is either read or refused with a message of one line.
// Each refractive index is a finite number.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "materials/io/index_record.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace materials = retrace::materials;
  try {
    const materials::Material material =
        materials::parse_index_record({reinterpret_cast<const char*>(data), size}, "fuzz.yml");
    for (const double wavelength_nm : {material.valid_from_nm, 587.56, material.valid_to_nm}) {
      if (!(materials::absorption_per_mm(material, wavelength_nm) >= 0.0)) std::abort();
      if (!std::isfinite(materials::refractive_index(material.dispersion, wavelength_nm))) std::abort();
    }
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
