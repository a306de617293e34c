// Reads any bytes as a record of refractiveindex.info. The record is either read or refused with a message of one line.
// Each refractive index is a finite number.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "materials/io/index_record.h"

namespace {

namespace materials = retrace::materials;

void require_one_line(const retrace::InputError& error) {
  const std::string_view message = error.what();
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  if (message.empty() || std::any_of(message.begin(), message.end(), is_control)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const materials::Material material =
        materials::parse_index_record({reinterpret_cast<const char*>(data), size}, "fuzz.yml");
    for (const double wavelength_nm : {material.valid_from_nm, 587.56, material.valid_to_nm}) {
      if (!(materials::absorption_per_mm(material, wavelength_nm) >= 0.0)) std::abort();
      if (!std::isfinite(materials::refractive_index(material.dispersion, wavelength_nm))) std::abort();
    }
  } catch (const retrace::InputError& error) {
    require_one_line(error);
  }
  return 0;
}
