#pragma once

// Reads numbers from text, independent of the locale and of the standard library.

#include <cstddef>
#include <optional>
#include <string_view>

namespace retrace {

/// A number at the beginning of a text.
struct LeadingNumber {
  double value = 0.0;
  std::size_t length = 0;  ///< length of the number's text
};

/// Returns the number at the beginning of a text, like std::from_chars: without leading blanks or plus sign, and with a
/// decimal point in every locale. "inf" and "nan" are numbers. Returns nothing if the text does not begin with a
/// number, or if the number is beyond the range of doubles.
std::optional<LeadingNumber> leading_number(std::string_view text);

}  // namespace retrace
