// Reads surface data files (SDF). Each file consists of the fixed first word of the format and the fuzz input.

#include "tests/fuzz/height_map_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_height_map("aISO-1.0", data, size, "fuzz.sdf");
  return 0;
}
