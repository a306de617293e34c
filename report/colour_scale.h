#pragma once

// Colours for values and luminances: the cubehelix scale, tone mapping for displays, and sRGB bytes.

#include <array>
#include <vector>

namespace retrace::report {

/// Colours from black to white of evenly rising brightness: the cubehelix of D. A. Green, Bull. Astr. Soc. India 39,
/// 289 (2011), with start 0.5, -1.5 turns, hue 1 and gamma 1. Read as grey they keep their order.
/// \param share 0..1, clamped \return sRGB, each 0..1
std::array<double, 3> cubehelix(double share);

/// Luminances as a display shows them: the global operator of E. Reinhard et al., ACM Trans. Graph. 21, 267 (2002),
/// eq. 4, with the logarithmic mean of what is lit at `key` of white and the 99.9th percentile as white.
/// \param luminance each >= 0 \return display intensities 0..1, linear
std::vector<double> tone_mapped(const std::vector<double>& luminance, double key = 0.18);

/// An intensity 0..1 as a byte of sRGB (IEC 61966-2-1).
unsigned char srgb_byte(double linear);

}  // namespace retrace::report
