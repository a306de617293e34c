#pragma once

// Numbers as text, independent of the locale: the shortest text that reads back equal, or a fixed number of digits.

#include <string>

namespace retrace {

/// The shortest decimal text that reads back as exactly `value`, with a decimal point whatever the locale; no exponent
/// unless it is shorter. `value` must be finite.
std::string shortest(double value);

/// `value` with `digits` digits after the decimal point, whatever the locale. A result that rounds to zero has no sign.
std::string fixed(double value, int digits);

}  // namespace retrace
