// Reads arbitrary bytes as a file of cubes. Text that begins with the letter "x" is read as CSV, and all other text as
// TOML. Each file must either be read or be refused with a message of one line. If a file is read, all numbers must be
// finite, and all axes must be unit vectors.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "studies/ranging/io/cubes_reader.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace retrace;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const std::vector<studies::ArrayCube> cubes = size > 0 && data[0] == 'x'
                                                      ? studies::parse_cube_table(text, "fuzz.csv")
                                                      : studies::parse_cubes(text, "fuzz.toml");
    if (cubes.empty()) std::abort();
    for (const studies::ArrayCube& cube : cubes) {
      if (!cube.position_mm.allFinite() || !std::isfinite(cube.clocking_deg)) std::abort();
      if (!(std::abs(cube.axis.norm() - 1.0) < 1e-12)) std::abort();
    }
  } catch (const InputError& error) {
    fuzz::require_one_line(error);
  }
  return 0;
}
