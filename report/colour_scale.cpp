#include "report/colour_scale.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::report {
namespace {

constexpr double kWhiteFraction = 0.999;
// Luminance, as a fraction of the maximum, below which a pixel counts as dark. Dark pixels are not included in the
// mean.
constexpr double kDark = 1e-5;

/// Returns the value below which the given fraction of all values is located.
double percentile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::array<double, 3> cubehelix(double fraction) {
  const double at = std::clamp(fraction, 0.0, 1.0);
  const double turn = 2.0 * std::numbers::pi * (0.5 / 3.0 + 1.0 - 1.5 * at);
  const double amplitude = 0.5 * at * (1.0 - at);
  const double c = std::cos(turn);
  const double s = std::sin(turn);
  const auto channel = [&](double along, double across) {
    return std::clamp(at + amplitude * (along * c + across * s), 0.0, 1.0);
  };
  return {channel(-0.14861, 1.78277), channel(-0.29227, -0.90649), channel(1.97294, 0.0)};
}

std::vector<double> tone_mapped(const std::vector<double>& luminance, double key) {
  std::vector<double> shown(luminance.size(), 0.0);
  if (luminance.empty()) return shown;
  const double brightest = *std::max_element(luminance.begin(), luminance.end());
  if (!(brightest > 0.0)) return shown;
  std::vector<double> lit;
  double logs = 0.0;
  for (const double value : luminance)
    if (value > kDark * brightest) {
      lit.push_back(value);
      logs += std::log(value);
    }
  const double scale = key / std::exp(logs / static_cast<double>(lit.size()));
  const double white = scale * percentile(lit, kWhiteFraction);
  for (std::size_t k = 0; k < luminance.size(); ++k) {
    const double x = scale * luminance[k];
    shown[k] = std::min(1.0, x * (1.0 + x / (white * white)) / (1.0 + x));
  }
  return shown;
}

unsigned char srgb_byte(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<unsigned char>(std::lround(255.0 * encoded));
}

}  // namespace retrace::report
