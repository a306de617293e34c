#pragma once

// The colour space sRGB (IEC 61966-2-1).

#include <array>
#include <cmath>

namespace retrace {

/// Returns the linear value of an encoded value; both are 0..1.
inline double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Returns the encoded value of a linear value; both are 0..1.
inline double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Returns the luminance of linear values, in the same unit. The coefficients are those of the standard, with four
/// digits.
inline double srgb_luminance(const std::array<double, 3>& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

}  // namespace retrace
