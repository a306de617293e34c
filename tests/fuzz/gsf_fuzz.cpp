// Reads Gwyddion Simple Field files. Each file consists of the fixed first words of the format and the fuzz input.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("Gwyddion Simple Field 1.0", data, size, "fuzz.gsf");
  return 0;
}
