// Reads any bytes as a process file. The result is a process or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "fabrication/job/io/process_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    static_cast<void>(retrace::fabrication::parse_process(text, "fuzz"));
  } catch (const retrace::InputError&) {
  }
  return 0;
}
