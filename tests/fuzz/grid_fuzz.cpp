// Text grids and every other format as its content says: the corpus holds whole files.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("", data, size, "fuzz.txt");
  return 0;
}
