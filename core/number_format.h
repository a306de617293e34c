#pragma once

// Converts numbers to text with the shortest exact text or a fixed number of digits. The decimal separator is always a
// point, independent of the locale.

#include <string>

namespace retrace {

/// Returns the shortest decimal text that reads back as exactly `value`. An exponent is used only if it makes the text
/// shorter. Infinity and NaN are returned as "inf" and "nan".
std::string shortest(double value);

/// Returns `value` with `digits` digits after the decimal point. A result that rounds to zero has no sign.
std::string fixed(double value, int digits);

/// Returns fixed(value, digits) if this text shows at least two significant digits of `value`. Otherwise returns
/// `value` with up to three significant digits, for example 0.004 instead of 0.00. Magnitudes below 1e-6 are regarded
/// as rounding errors of 0, for which fixed(value, digits) is returned.
std::string fixed_visible(double value, int digits);

/// Returns `value` rounded to `digits` digits after the decimal point, without zeros at its end. More digits are used
/// if rounding to `digits` digits would make `value` equal to `other` or move it to the other side of `other`. This
/// prevents messages that state, for example, that 88 exceeds 88.
std::string fixed_apart(double value, double other, int digits);

}  // namespace retrace
