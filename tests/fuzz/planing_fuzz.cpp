// Any text of a planed-part file is either read or refused with a message of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/error.h"
#include "fabrication/planing/io/part_files.h"
#include "tests/fuzz/one_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fabrication = retrace::fabrication;
  try {
    const auto part = fabrication::parse_planed_part({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (part.mill.has_value() == part.lathe.has_value()) std::abort();
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
