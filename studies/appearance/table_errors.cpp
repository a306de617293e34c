#include "studies/appearance/table_errors.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace retrace::studies {

using geometry::Vec2, geometry::Vec3;

double error_of(double interpolated, double reference, double maximum) {
  return std::abs(interpolated - reference) / std::max({reference, kErrorFloor * maximum, 1e-300});
}

double quantile(std::vector<double> errors, double fraction) {
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<std::size_t>(fraction * static_cast<double>(errors.size() - 1))];
}

double percentile_95_of(const std::vector<double>& errors) {
  return quantile(errors, 0.95);
}

Vec2 random_deviation(const ReflectionTable& table, std::uint32_t x, std::uint32_t y) {
  return table.half_width * Vec2(2.0 * unit_interval(x) - 1.0, 2.0 * unit_interval(y) - 1.0);
}

std::optional<raytrace::PhotometricDirections> view_at(const ReflectionTable& table, const Vec3& to_source,
                                                       const Vec2& deviation) {
  const Vec2 across = table.central_direction(to_source) + deviation;
  if (across.squaredNorm() >= 1.0) return std::nullopt;
  return raytrace::PhotometricDirections{to_source, {across.x(), across.y(), std::sqrt(1.0 - across.squaredNorm())}};
}

double max_r_a(const ReflectionTable& table, const Vec3& to_source) {
  const auto among = table.at(to_source).value();
  double most = 0.0;
  for (std::size_t place = 0; place < table.columns * table.columns; ++place) {
    double value = 0.0;
    for (std::size_t k = 0; k < among.directions.size(); ++k)
      value += among.weights[k] * luminous(table.directions[among.directions[k]].r_a[place]);
    most = std::max(most, value);
  }
  return most;
}

}  // namespace retrace::studies
