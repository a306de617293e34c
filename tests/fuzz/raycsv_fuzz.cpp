// Reads any bytes as a table of rays.

#include "studies/rays/io/ray_csv.h"
#include "tests/fuzz/ray_reading.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_rays<retrace::studies::RayCsvSource>(data, size, "fuzz.csv");
  return 0;
}
