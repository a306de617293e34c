#pragma once

// Small operations on text: trimming, splitting, lower case, numbers independent of the locale, endings of file names,
// texts in XML and HTML, and the length of UTF-8 characters.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrace {

/// `text` without blanks, tabs and carriage returns at its ends.
std::string_view trimmed(std::string_view text);

/// Returns `text` without the UTF-8 byte order mark that some programs write at the beginning of a file.
std::string_view without_byte_order_mark(std::string_view text);

/// Returns `text` with the letters A to Z in lower case. Other characters are unchanged.
std::string lower_case(std::string_view text);

/// What stands between separators, trimmed; at least one part.
std::vector<std::string_view> split(std::string_view text, char separator);

/// What stands between blanks, tabs and ends of lines.
std::vector<std::string_view> words_in(std::string_view text);

/// The finite number that `text` is, with a decimal point whatever the locale; none if it is anything else.
std::optional<double> number_in(std::string_view text);

/// The ending of a file's name in small letters, with its dot; empty if it has none.
std::string ending_of(const std::filesystem::path& file);

/// Returns `text` for use in an XML or HTML document. The characters & < > " ' are replaced by character references.
std::string markup_text(std::string_view text);

/// Bytes of the UTF-8 character that `text` begins with; 0 if they are none (overlong and surrogate forms included).
/// \pre text is not empty
std::size_t utf8_length(std::string_view text);

}  // namespace retrace
