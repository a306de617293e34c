// Reads any bytes as a height map whose format is determined by its content, such as a text grid. The corpus contains
// complete files.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("", data, size, "fuzz.txt");
  return 0;
}
