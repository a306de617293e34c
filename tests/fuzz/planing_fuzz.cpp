// Any text of a planed-part file is either read or refused with a message of one line.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "fabrication/planing/io/part_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fabrication = retrace::fabrication;
  try {
    const auto part = fabrication::parse_planed_part({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    if (part.mill.has_value() == part.lathe.has_value()) std::abort();
  } catch (const retrace::InputError& error) {
    const std::string_view message = error.what();
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
    if (message.empty() || std::any_of(message.begin(), message.end(), is_control)) std::abort();
  }
  return 0;
}
