#pragma once

// Numbers as text, independent of the locale: the shortest text that reads back equal, or a fixed number of digits.

#include <string>

namespace retrace {

/// The shortest decimal text that reads back as exactly `value`, with a decimal point whatever the locale; no exponent
/// unless it is shorter. `value` must be finite.
std::string shortest(double value);

/// `value` with `digits` digits after the decimal point, whatever the locale. A result that rounds to zero has no sign.
std::string fixed(double value, int digits);

/// Returns fixed(value, digits) if it shows at least two significant digits. Otherwise returns `value` with up to three
/// significant digits: 0.004 instead of 0.00. A magnitude below 1e-6 counts as a rounding error; fixed(value,
/// digits) is then returned.
std::string fixed_visible(double value, int digits);

/// Returns fixed(value, digits). If rounding would move the value to `other` or past it, the text has more digits.
/// Otherwise, a message could state that 88.00 exceeds 88.
std::string fixed_apart(double value, double other, int digits);

}  // namespace retrace
