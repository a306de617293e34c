// Reads native files of Gwyddion. The input follows the fixed first four bytes.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("GWYP", data, size, "fuzz.gwy");
  return 0;
}
