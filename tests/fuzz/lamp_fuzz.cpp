// Reads any bytes as a photometric file. The first byte selects the format, LM-63 or EULUMDAT. The file is either read
// or refused with a message of one line. A lamp that is read has a flux, and an intensity in every direction.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "studies/image/io/lamp_reader.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const studies::PhotometricLamp lamp =
        size > 0 && data[0] == 'I' ? studies::parse_ies(text, "fuzz.ies") : studies::parse_ldt(text, "fuzz.ldt");
    if (!std::isfinite(lamp.intensity.lumens())) std::abort();
    for (int k = 0; k < 64; ++k)
      if (!(lamp.intensity.cd({std::cos(k), std::sin(0.7 * k), std::cos(1.3 * k)}) >= 0.0)) std::abort();
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
