#include "core/number_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace retrace {
namespace {

/// A decimal number d.ddd * 10^exponent.
struct Decimal {
  std::string digits;  ///< shortest digits that determine the double; no decimal point, no trailing zeros
  int exponent = 0;
};

/// Splits the text of a number into digits and exponent.
/// \param text shortest text of a number > 0, such as 0.001, 1234.5 or 1e-07
Decimal decimal_of(std::string_view text) {
  const std::size_t e = text.find('e');
  const std::string_view mantissa = text.substr(0, e);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  Decimal decimal;
  decimal.exponent = static_cast<int>(point) - static_cast<int>(first) - (first < point ? 1 : 0);
  if (e != std::string_view::npos) decimal.exponent += std::atoi(std::string(text.substr(e + 1)).c_str());
  for (const char c : mantissa.substr(first))
    if (c != '.') decimal.digits += c;
  decimal.digits.erase(decimal.digits.find_last_not_of('0') + 1);
  return decimal;
}

std::string with_exponent(const Decimal& d) {
  const std::string_view digits = d.digits;
  return fmt::format("{}{}{}e{:+03d}", digits.substr(0, 1), digits.size() > 1 ? "." : "", digits.substr(1), d.exponent);
}

std::string without_exponent(const Decimal& d, double magnitude) {
  if (d.exponent < 0) return "0." + std::string(static_cast<std::size_t>(-d.exponent - 1), '0') + d.digits;
  // Integers are printed with all their digits. `d.digits` may have fewer, because the last digits of a large integer
  // need not be given to determine the double.
  if (d.exponent + 1 >= static_cast<int>(d.digits.size())) return fmt::format("{:.0f}", magnitude);
  std::string text = d.digits;
  return text.insert(static_cast<std::size_t>(d.exponent) + 1, ".");
}

/// Returns the shortest text of a positive number.
/// \param magnitude finite and > 0
std::string shortest_of(double magnitude) {
  std::string text = fmt::format("{}", magnitude);
  // True if an exponent cannot make the text shorter.
  const bool is_plain =
      text.find('e') == std::string::npos && (text.find('.') != std::string::npos || text.size() <= 5);
  if (is_plain && magnitude >= 1e-3) return text;
  const Decimal decimal = decimal_of(text);
  text = with_exponent(decimal);
  if (std::abs(decimal.exponent) > static_cast<int>(text.size())) return text;
  const std::string plain = without_exponent(decimal, magnitude);
  return plain.size() > text.size() ? text : plain;
}

/// Returns the decimal text without the zeros at the end of its fractional part.
std::string without_trailing_zeros(std::string text) {
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

std::string shortest(double value) {
  if (value == 0.0) return "0";
  if (!std::isfinite(value)) return fmt::format("{}", value);
  return value < 0.0 ? "-" + shortest_of(-value) : shortest_of(value);
}

std::string fixed(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (is_zero && text.front() == '-') text.erase(0, 1);
  return text;
}

std::string fixed_visible(double value, int digits) {
  constexpr double kRounding = 1e-6;
  const double magnitude = std::abs(value);
  if (!(magnitude >= kRounding && magnitude < std::pow(10.0, 1 - digits))) return fixed(value, digits);
  return fmt::format("{:.3g}", value);
}

std::string fixed_apart(double value, double other, int digits) {
  constexpr int kMaxDigits = 17;
  for (; digits <= kMaxDigits; ++digits) {
    std::string text = fixed(value, digits);
    const double shown = std::strtod(text.c_str(), nullptr);
    if ((shown < other) == (value < other) && (shown > other) == (value > other))
      return without_trailing_zeros(std::move(text));
  }
  return shortest(value);
}

}  // namespace retrace
