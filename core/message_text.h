#pragma once

// Functions for messages: escape text from files and options, list allowed values, and find the known name that is
// most similar to a misspelled name.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace retrace {

/// Returns the length in bytes of the first UTF-8 character of `text` if this character is printable. Otherwise returns
/// 0.
/// \pre `text` is not empty
std::size_t printable_length(std::string_view text);

/// Returns `text` for use in a one-line message. Control characters, noncharacters (U+FFFE, U+FFFF) and invalid UTF-8
/// are replaced by escapes such as `\n` and `\x1b`. A result longer than `max_bytes` is cut and ends in "...".
std::string printable(std::string_view text, std::size_t max_bytes = 80);

/// Returns `text` for output on a terminal. Line feeds and tabs are kept. Other control characters, noncharacters and
/// invalid UTF-8 are replaced by escapes. The text is not cut.
std::string printable_lines(std::string_view text);

/// Returns printable(text) between double quotes.
std::string in_quotes(std::string_view text);

/// Returns the names as a list in double quotes: `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> names);

/// Returns the name that is most similar to the misspelled name `given`, for a "did you mean" message. The edit
/// distance may be at most a third of the length of `given`, but at least 1. Returns an empty text if no name is
/// similar enough.
std::string_view closest_match(std::string_view given, std::span<const std::string_view> names);

}  // namespace retrace
