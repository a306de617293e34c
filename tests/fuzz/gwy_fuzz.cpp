// Reads native files of Gwyddion. Each file consists of the fixed first four bytes of the format and the fuzz input.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("GWYP", data, size, "fuzz.gwy");
  return 0;
}
