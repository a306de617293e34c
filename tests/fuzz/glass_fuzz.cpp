// Reads any bytes as a glass catalogue. Each glass is either read or refused with a message of one line. Each
// refractive index is a finite number.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "materials/io/glass_catalogue.h"
#include "tests/fuzz/one_line.h"

namespace {

namespace materials = retrace::materials;

void use(const materials::Material& glass) {
  for (const double wavelength_nm : {glass.valid_from_nm, 587.56, glass.valid_to_nm}) {
    if (!(materials::absorption_per_mm(glass, wavelength_nm) >= 0.0)) std::abort();
    try {
      if (!std::isfinite(materials::refractive_index(glass.dispersion, wavelength_nm))) std::abort();
    } catch (const retrace::InputError& error) {
      retrace::fuzz::require_one_line(error);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const materials::GlassCatalogue catalogue({reinterpret_cast<const char*>(data), size}, "fuzz.agf");
    for (const std::string& name : catalogue.names()) try {
        catalogue.require(name, {});
        use(catalogue.glass(name));
      } catch (const retrace::InputError& error) {
        retrace::fuzz::require_one_line(error);
      }
    catalogue.require("N-BK7", {"d.toml", 1, "body.material"});
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
