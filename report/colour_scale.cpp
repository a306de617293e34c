#include "report/colour_scale.h"

#include <algorithm>
#include <cmath>

#include "core/srgb.h"

namespace retrace::report {
namespace {

constexpr double kWhiteFraction = 0.999;
// Luminance, as a fraction of the maximum, below which a pixel counts as dark. Dark pixels are not included in the
// mean.
constexpr double kDark = 1e-5;
// Luminance in cd/m^2 that saturates a sensor at an exposure value of 0: 78 / (100 x 0.65) (ISO 12232).
constexpr double kSaturation = 1.2;

/// Returns the value below which the given fraction of all values is located.
double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::array<double, 3> light_colour(double fraction) {
  // Colours in CIELAB with the hue angle 264 degrees and lightness 5 to 98 in equal steps. The chroma is at most the
  // largest chroma that sRGB can display.
  static constexpr std::array<std::array<double, 3>, 9> kScale = {{{0.000, 0.073, 0.138},
                                                                   {0.000, 0.171, 0.280},
                                                                   {0.000, 0.276, 0.432},
                                                                   {0.009, 0.388, 0.596},
                                                                   {0.000, 0.506, 0.770},
                                                                   {0.305, 0.622, 0.882},
                                                                   {0.534, 0.740, 0.950},
                                                                   {0.748, 0.859, 0.991},
                                                                   {0.965, 0.979, 0.998}}};
  const double at = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(kScale.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), kScale.size() - 2);
  std::array<double, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = std::lerp(kScale[k][c], kScale[k + 1][c], at - static_cast<double>(k));
  return colour;
}

Tone tone_of(std::string_view name) {
  if (name == "linear") return Tone::linear;
  return name == "log" ? Tone::log : Tone::reinhard;
}

double ToneCurve::shown(double luminance) const {
  if (!(luminance > 0.0)) return 0.0;
  switch (tone) {
    case Tone::linear: return std::min(1.0, luminance / white);
    case Tone::log: return linear_from_srgb(std::clamp(1.0 + std::log10(luminance / white) / kToneDecades, 0.0, 1.0));
    case Tone::reinhard: break;
  }
  const double scale = key / grey;
  const double x = scale * luminance;
  const double x_white = scale * white;
  return std::min(1.0, x * (1.0 + x / (x_white * x_white)) / (1.0 + x));
}

double ToneCurve::ev100() const {
  return std::log2(white / kSaturation);
}

ToneCurve tone_of_exposure(double ev100, Tone tone) {
  return {tone, kSaturation * std::exp2(ev100), 0.125 * std::exp2(ev100)};
}

ToneCurve tone_of_picture(const std::vector<double>& luminance, Tone tone, double key) {
  ToneCurve curve{tone, 1.0, 1.0, key};
  if (luminance.empty()) return curve;
  const double brightest = *std::max_element(luminance.begin(), luminance.end());
  if (!(brightest > 0.0)) return curve;
  std::vector<double> lit;
  double logs = 0.0;
  for (const double value : luminance)
    if (value > kDark * brightest) {
      lit.push_back(value);
      logs += std::log(value);
    }
  curve.grey = std::exp(logs / static_cast<double>(lit.size()));
  curve.white = percentile(lit, kWhiteFraction);
  return curve;
}

std::vector<double> tone_mapped(const std::vector<double>& luminance, double key) {
  const ToneCurve curve = tone_of_picture(luminance, Tone::reinhard, key);
  std::vector<double> shown;
  shown.reserve(luminance.size());
  for (const double value : luminance) shown.push_back(curve.shown(value));
  return shown;
}

unsigned char srgb_byte(double linear) {
  return static_cast<unsigned char>(std::lround(255.0 * srgb_from_linear(std::clamp(linear, 0.0, 1.0))));
}

}  // namespace retrace::report
