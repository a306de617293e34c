#include "raytrace/balls/ball_forms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::raytrace {
namespace {

// Number of heights from 0 to 1 at which the return error is evaluated. The error is a smooth function of the height
// except at height 1, where its slope is infinite.
constexpr int kHeights = 20000;

double sine_of_step(int k) {
  return std::sin(0.5 * std::numbers::pi * k / kHeights);
}

}  // namespace

double return_error_rad(double height, double index, double spacer_index, double mirror_radius_over_radius) {
  return 2.0 * std::asin(height) - 4.0 * std::asin(height / index) + 2.0 * std::asin(height / spacer_index) -
         2.0 * std::asin(height / (spacer_index * mirror_radius_over_radius));
}

double paraxial_error(double index, double spacer_index, double mirror_radius_over_radius) {
  return 2.0 * (1.0 - 2.0 / index + (1.0 - 1.0 / mirror_radius_over_radius) / spacer_index);
}

std::optional<double> focal_offset_over_radius(double index, double spacer_index) {
  // (1 - R / rho) / m = 2 / n - 1
  const double radius_over_rho = 1.0 - spacer_index * (2.0 / index - 1.0);
  if (!(index < 2.0) || !(radius_over_rho > 0.0)) return std::nullopt;
  return 1.0 / radius_over_rho - 1.0;
}

double fraction_within(double half_angle_rad, double index, double spacer_index, double mirror_radius_over_radius) {
  const auto error = [&](int k) {
    return std::abs(return_error_rad(sine_of_step(k), index, spacer_index, mirror_radius_over_radius));
  };
  double share = 0.0;
  for (int k = 0; k < kHeights; ++k) {
    const double inner = std::pow(sine_of_step(k), 2.0);
    const double outer = std::pow(sine_of_step(k + 1), 2.0);
    const double from = error(k) - half_angle_rad;
    const double to = error(k + 1) - half_angle_rad;
    if (from <= 0.0 && to <= 0.0) share += outer - inner;
    // If the error crosses the limit `half_angle_rad` between two heights, it is interpolated linearly.
    if ((from <= 0.0) != (to <= 0.0)) share += (outer - inner) * std::max(-from, -to) / std::abs(to - from);
  }
  return share;
}

double largest_return_error_rad(double index, double spacer_index, double mirror_radius_over_radius) {
  double largest = 0.0;
  for (int k = 0; k <= kHeights; ++k)
    largest =
        std::max(largest, std::abs(return_error_rad(sine_of_step(k), index, spacer_index, mirror_radius_over_radius)));
  return largest;
}

double packing_fraction(const BallLayer& layer) {
  if (!layer.pitch_mm) return 1.0;
  return std::numbers::pi / (2.0 * std::numbers::sqrt3) * std::pow(layer.diameter_mm / *layer.pitch_mm, 2.0);
}

}  // namespace retrace::raytrace
