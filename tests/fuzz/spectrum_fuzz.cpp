// Any spectrum file of a lamp is either read as wavelengths and weights with the sum 1, or refused with a message of
// one line.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "materials/io/spectrum_reader.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace materials = retrace::materials;
  try {
    const auto lamp = materials::parse_spectral_power({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    const auto rule = materials::traced_spectrum(materials::resolved_spectrum(lamp, nullptr));
    double total = 0.0;
    for (const double weight : rule.weights) total += weight;
    if (!(std::abs(total - 1.0) < 1e-9) || !std::is_sorted(rule.wavelengths_nm.begin(), rule.wavelengths_nm.end()))
      std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
