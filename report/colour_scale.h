#pragma once

// Colours for values and luminances: a scale of one hue, tone mapping for displays, and sRGB bytes.

#include <array>
#include <string_view>
#include <vector>

namespace retrace::report {

/// Returns a colour of a scale from nearly black to nearly white with one hue, blue. Its lightness (CIE L*) increases
/// uniformly from 5 to 98, so that the order of the colours is preserved if a picture is converted to grey.
/// \param fraction position on the scale, clamped to 0..1
/// \return sRGB, each 0..1
std::array<double, 3> light_colour(double fraction);

/// Curves by which luminances are displayed. `log` covers the four decades below white.
enum class Tone { reinhard, linear, log };
/// \pre `name` is "reinhard", "linear" or "log"
Tone tone_of(std::string_view name);

/// Number of decades that Tone::log shows.
inline constexpr double kToneDecades = 4.0;

/// Converts luminances to display intensities.
struct ToneCurve {
  Tone tone = Tone::reinhard;
  double white = 1.0;  ///< luminance that is displayed as white; > 0
  double grey = 0.1;   ///< luminance that Tone::reinhard maps to about the intensity `key`; > 0
  double key = 0.18;

  /// Returns a display intensity 0..1, linear. Tone::reinhard is the global operator of E. Reinhard et al., ACM Trans.
  /// Graph. 21, 267 (2002), eq. 4.
  double shown(double luminance) const;
  /// Returns the exposure value at ISO 100, for which 1.2 x 2^EV cd/m^2 saturate a sensor (ISO 12232, saturation-based
  /// speed with the lens factor 0.65).
  double ev100() const;
};

/// Returns the curve for an exposure value at ISO 100. The luminance that an exposure meter with the constant 12.5
/// regards as the mean of the scene, 2^EV / 8 cd/m^2 (ISO 2720), is the grey of Tone::reinhard.
ToneCurve tone_of_exposure(double ev100, Tone tone);
/// Returns the curve for which the 99.9th percentile of the pixels that are not dark is white. Their logarithmic mean
/// is the grey of Tone::reinhard.
ToneCurve tone_of_picture(const std::vector<double>& luminance, Tone tone, double key = 0.18);

/// Converts the luminances of a picture to display intensities, with Tone::reinhard and the curve of tone_of_picture().
/// \param luminance each >= 0
/// \return display intensities 0..1, linear
std::vector<double> tone_mapped(const std::vector<double>& luminance, double key = 0.18);

/// Returns an intensity 0..1 as a byte of sRGB (IEC 61966-2-1).
unsigned char srgb_byte(double linear);

}  // namespace retrace::report
