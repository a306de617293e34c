// Reads any bytes as a list of points.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("", data, size, "fuzz.xyz");
  return 0;
}
