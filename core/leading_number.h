#pragma once

// Reads numbers from text, independent of the locale and of the standard library.

#include <cstddef>
#include <optional>
#include <string_view>

namespace retrace {

/// A number at the beginning of a text.
struct LeadingNumber {
  double value = 0.0;
  std::size_t length = 0;  ///< length of the number's text in bytes
};

/// Returns the number at the beginning of a text. The syntax is that of std::from_chars: no leading blanks, no plus
/// sign, and a decimal point in every locale. "inf" and "nan" are numbers. Returns nothing if the text does not begin
/// with a number, or if the number is outside the range of doubles.
std::optional<LeadingNumber> leading_number(std::string_view text);

}  // namespace retrace
