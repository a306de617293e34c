#include "raytrace/light/direction_score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::raytrace {
namespace {

using geometry::Vec2, std::numbers::pi;

/// Returns the solid angle of a rectangle in the azimuthal equidistant projection, whose coordinates are the angles of
/// ReturnFrame. It is the integral of sin(r) / r over the rectangle, computed with a Gauss rule of 3 x 3 points.
double square_solid_angle(const Vec2& middle_rad, double width_rad, double height_rad) {
  const GaussRule rule = gauss_legendre(3);
  double sum = 0.0;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const double r = std::hypot(middle_rad.x() + width_rad * (rule.nodes[i] - 0.5),
                                  middle_rad.y() + height_rad * (rule.nodes[j] - 0.5));
      sum += rule.weights[i] * rule.weights[j] * (r > 0.0 ? std::sin(r) / r : 1.0);
    }
  return sum * width_rad * height_rad;
}

}  // namespace

std::optional<std::size_t> DirectionGrid::bin_of(const Vec2& angles_rad) const {
  const double rows = static_cast<double>(rows_);
  const double columns = static_cast<double>(columns_);
  double row = 0.0;
  double column = 0.0;
  if (layout_ == Layout::square) {
    row = std::floor(rows * 0.5 * (1.0 + angles_rad.y() / half_width_rad_));
    column = std::floor(columns * 0.5 * (1.0 + angles_rad.x() / half_width_rad_));
    if (!(column >= 0.0 && column < columns)) return std::nullopt;
  } else {
    row = std::floor(rows * angles_rad.norm() / half_width_rad_);
    const double turn = std::atan2(angles_rad.y(), angles_rad.x()) / (2.0 * pi);
    column = std::min(std::floor(columns * (turn < 0.0 ? turn + 1.0 : turn)), columns - 1.0);
  }
  if (!(row >= 0.0 && row < rows)) return std::nullopt;
  return static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
}

Vec2 DirectionGrid::centre_rad(std::size_t bin) const {
  const double row = (static_cast<double>(bin / columns_) + 0.5) / static_cast<double>(rows_);
  const double column = (static_cast<double>(bin % columns_) + 0.5) / static_cast<double>(columns_);
  if (layout_ == Layout::square) return half_width_rad_ * Vec2(2.0 * column - 1.0, 2.0 * row - 1.0);
  return half_width_rad_ * row * Vec2(std::cos(2.0 * pi * column), std::sin(2.0 * pi * column));
}

double DirectionGrid::solid_angle_sr(std::size_t bin) const {
  if (layout_ == Layout::square)
    return square_solid_angle(centre_rad(bin), 2.0 * half_width_rad_ / static_cast<double>(columns_),
                              2.0 * half_width_rad_ / static_cast<double>(rows_));
  const double step = half_width_rad_ / static_cast<double>(rows_);
  const double inner = static_cast<double>(bin / columns_) * step;
  // This is cos(inner) - cos(inner + step), in a form without cancellation.
  return 4.0 * pi / static_cast<double>(columns_) * std::sin(inner + 0.5 * step) * std::sin(0.5 * step);
}

void DirectionScore::add(const geometry::Vec3& direction, double power, std::vector<double>& sums) const {
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    const double chord = (direction - receivers[k]).norm();
    if (chord > 1.01 * kernel.reach_rad() + 1e-12) continue;
    sums[k] += power * kernel.per_sr(2.0 * std::asin(0.5 * chord));
  }
  if (!grid) return;
  const std::size_t bin = grid->bin_of(frame.angles_rad(direction)).value_or(grid->size());
  sums[receivers.size() + bin] += power;
}

}  // namespace retrace::raytrace
