#include "core/leading_number.h"

#include <fast_float/fast_float.h>

#include <cmath>

namespace retrace {

std::optional<LeadingNumber> leading_number(std::string_view text) {
  LeadingNumber number;
  const auto [end, error] = fast_float::from_chars(text.data(), text.data() + text.size(), number.value);
  if (error != std::errc{}) return std::nullopt;
  number.length = static_cast<std::size_t>(end - text.data());
  const std::string_view read = text.substr(0, number.length);
  const std::string_view mantissa = read.substr(0, read.find_first_of("eE"));
  const bool has_digits = mantissa.find_first_of("123456789") != std::string_view::npos;
  // The number is outside the range of doubles. It was read as infinity, or as 0 although its text is not 0.
  if (has_digits && (std::isinf(number.value) || number.value == 0.0)) return std::nullopt;
  return number;
}

}  // namespace retrace
