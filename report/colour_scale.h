#pragma once

// Colours for values and luminances: the cubehelix scale, tone mapping for displays, and sRGB bytes.

#include <array>
#include <vector>

namespace retrace::report {

/// Returns a colour of a scale from black to white with uniformly increasing brightness: the cubehelix of D. A. Green,
/// Bull. Astr. Soc. India 39, 289 (2011), with start 0.5, -1.5 turns, hue 1 and gamma 1. The order of the colours is
/// preserved if a picture is converted to grey.
/// \param fraction position on the scale, clamped to 0..1
/// \return sRGB, each 0..1
std::array<double, 3> cubehelix(double fraction);

/// Converts luminances to display intensities with the global operator of E. Reinhard et al., ACM Trans. Graph. 21, 267
/// (2002), eq. 4. The logarithmic mean of the pixels that are not dark is mapped to the intensity `key`. The 99.9th
/// percentile is mapped to white.
/// \param luminance each >= 0
/// \return display intensities 0..1, linear
std::vector<double> tone_mapped(const std::vector<double>& luminance, double key = 0.18);

/// Returns an intensity 0..1 as a byte of sRGB (IEC 61966-2-1).
unsigned char srgb_byte(double linear);

}  // namespace retrace::report
