// Reads any bytes as a turned-part file. The result is a part or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "fabrication/turning/io/part_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    static_cast<void>(retrace::fabrication::turning::parse_turned_part(text, "fuzz"));
  } catch (const retrace::InputError&) {
  }
  return 0;
}
