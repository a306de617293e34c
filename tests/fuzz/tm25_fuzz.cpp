// Reads any bytes as a TM-25 ray file.

#include "studies/rays/io/tm25.h"
#include "tests/fuzz/ray_reading.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  retrace::fuzz::read_rays<retrace::studies::Tm25Source>(data, size, "fuzz.tm25ray");
  return 0;
}
