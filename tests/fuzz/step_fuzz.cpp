// For any STEP file, the reader either returns a surface or throws an InputError of one line. A separate program reads
// each file, so this target is slower than others.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "geometry/io/step_reader.h"
#include "geometry/surface/step_surface.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace;
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fuzz" + std::to_string(::getpid()) + ".step");
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    geometry::read_step_surface({.file = file});
  } catch (const InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
