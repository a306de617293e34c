// For any text of a design file and any override, the reader either returns a design or throws an InputError of one
// line.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "design/io/design_reader.h"
#include "tests/fuzz/one_line.h"

namespace {

/// Returns the override in the first line if this line begins with "#--set ". For TOML, such a line is a comment.
std::string override_of(std::string_view text) {
  constexpr std::string_view mark = "#--set ";
  if (text.substr(0, mark.size()) != mark) return {};
  const std::string_view line = text.substr(0, text.find('\n'));
  return std::string(line.substr(mark.size()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  const std::array<std::string, 1> given = {override_of(text)};
  const std::span<const std::string> overrides(given.data(), given.front().empty() ? 0 : 1);
  try {
    retrace::design::parse_design(text, "fuzz.toml", overrides);
  } catch (const retrace::InputError& error) {
    retrace::fuzz::require_one_line(error);
  }
  return 0;
}
