#pragma once

// Reads numbers from text, independent of the locale and of the standard library.

#include <cstddef>
#include <optional>
#include <string_view>

namespace retrace {

/// A number at the beginning of a text.
struct LeadingNumber {
  double value = 0.0;
  std::size_t length = 0;  ///< of its text
};

/// The number that a text begins with, as std::from_chars reads it: no blank or plus before it, a decimal point
/// whatever the locale; inf and nan are numbers. None for another beginning, and beyond the range of doubles.
std::optional<LeadingNumber> leading_number(std::string_view text);

}  // namespace retrace
