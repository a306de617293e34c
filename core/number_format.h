#pragma once

// Numbers as text, independent of the locale: the shortest text that reads back equal, or a fixed number of digits.

#include <string>

namespace retrace {

/// The shortest decimal text that reads back as exactly `value`, with a decimal point whatever the locale; no exponent
/// unless it is shorter. `value` must be finite.
std::string shortest(double value);

/// `value` with `digits` digits after the decimal point, whatever the locale. A result that rounds to zero has no sign.
std::string fixed(double value, int digits);

/// Returns fixed(value, digits) if this text shows at least two significant digits of `value`. Otherwise returns
/// `value` with up to three significant digits, for example 0.004 instead of 0.00. A `value` with a magnitude below
/// 1e-6 counts as a rounding error of 0; for such a `value`, fixed(value, digits) is returned.
std::string fixed_visible(double value, int digits);

/// Returns `value` rounded to `digits` digits after the decimal point, without zeros at its end. More digits are used
/// if rounding to `digits` digits would make `value` equal to `other` or move it to the other side of `other`. This
/// prevents messages that state, for example, that 88 exceeds 88.
std::string fixed_apart(double value, double other, int digits);

}  // namespace retrace
