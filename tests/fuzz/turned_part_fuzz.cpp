// Any bytes as the file of a turned part: a part or an InputError, nothing else.
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
