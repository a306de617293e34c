#pragma once

// Texts of messages: foreign text made safe to print on one line, lists of what is allowed, and the nearest known name
// for a "did you mean".

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace retrace {

/// `text` for use in a one-line message: control characters and bytes that are not UTF-8 become `\n`, `\x1b` and the
/// like; what is longer than `max_bytes` ends in "...".
std::string printable(std::string_view text, std::size_t max_bytes = 80);

/// printable(text) between double quotes.
std::string in_quotes(std::string_view text);

/// `"a", "b" or "c"`.
std::string alternatives(std::span<const std::string_view> names);

/// The name that `given` was probably meant to be (edit distance up to a third of its length), or an empty text.
std::string_view closest(std::string_view given, std::span<const std::string_view> names);

}  // namespace retrace
