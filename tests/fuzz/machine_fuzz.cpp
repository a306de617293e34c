// Reads any bytes as a machine file. The result is a machine or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "fabrication/machine/io/machine_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto machine = retrace::fabrication::parse_machine(text, "fuzz");
    static_cast<void>(retrace::fabrication::inverse(machine, {1.0, 2.0, 3.0}, {45.0, 180.0}));
  } catch (const retrace::InputError&) {
  }
  return 0;
}
