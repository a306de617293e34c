#pragma once

// Text functions: trim, split, convert to lower case, parse numbers independent of the locale, get file extensions,
// escape text for XML and HTML, and determine the length of UTF-8 characters.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrace {

/// Returns `text` without leading and trailing spaces, tabs and carriage returns.
std::string_view trimmed(std::string_view text);

/// Returns `text` without the UTF-8 byte order mark that some programs write at the beginning of a file.
std::string_view without_byte_order_mark(std::string_view text);

/// Returns `text` with the letters A to Z in lower case. Other characters are unchanged.
std::string lower_case(std::string_view text);

/// Returns the path of a key or table with the given name within the table at the path `around`.
std::string path_in(std::string_view around, std::string_view name);

/// Splits `text` at each separator and trims the parts. The result has at least one part, which may be empty.
std::vector<std::string_view> split(std::string_view text, char separator);

/// Returns the words of `text`, which are separated by spaces, tabs and line ends.
std::vector<std::string_view> words_in(std::string_view text);

/// Parses the whole `text` as a finite number with a decimal point, independent of the locale. Returns nothing if
/// `text` is not such a number.
std::optional<double> number_in(std::string_view text);

/// Returns the extension of a file name in lower case, including the dot. Returns an empty text if there is none.
std::string ending_of(const std::filesystem::path& file);

/// Returns `text` for use in an XML or HTML document. The characters & < > " ' are replaced by character references.
std::string markup_text(std::string_view text);

/// Returns the length in bytes of the first UTF-8 character of `text`. Returns 0 if the text begins with invalid UTF-8,
/// including overlong encodings and surrogates.
/// \pre text is not empty
std::size_t utf8_length(std::string_view text);

}  // namespace retrace
