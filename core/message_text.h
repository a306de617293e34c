#pragma once

// Texts of messages: foreign text made safe to print on one line, lists of what is allowed, and the nearest known name
// for a "did you mean".

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace retrace {

/// Returns the length in bytes of the printable UTF-8 character that `text` begins with; 0 if it begins with anything
/// else.
std::size_t printable_length(std::string_view text);

/// Returns `text` for use in a one-line message. Control characters, noncharacters and bytes that are not UTF-8 are
/// replaced by escapes such as `\n` and `\x1b`. A text longer than `max_bytes` is cut and ends in "...".
std::string printable(std::string_view text, std::size_t max_bytes = 80);

/// Returns `text` for a terminal. Characters are replaced as by printable(), but ends of lines and tabs are kept, and
/// the text is not shortened.
std::string printable_lines(std::string_view text);

/// printable(text) between double quotes.
std::string in_quotes(std::string_view text);

/// `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> names);

/// The name that `given` was probably meant to be (edit distance up to a third of its length), or an empty text.
std::string_view closest(std::string_view given, std::span<const std::string_view> names);

}  // namespace retrace
