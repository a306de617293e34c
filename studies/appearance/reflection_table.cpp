#include "studies/appearance/reflection_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/srgb.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Tolerance, in radians, by which directions may lie outside the table because of rounding errors.
constexpr double kSlackRad = 1e-9;

/// Returns the weights of the values at 0, 1, 2 and 3 for the cubic through them, evaluated at `x`.
std::array<double, kDirectionsPerSide> cubic_weights(double x) {
  std::array<double, kDirectionsPerSide> weights{};
  for (std::size_t k = 0; k < kDirectionsPerSide; ++k) {
    weights[k] = 1.0;
    for (std::size_t other = 0; other < kDirectionsPerSide; ++other)
      if (other != k)
        weights[k] *= (x - static_cast<double>(other)) / (static_cast<double>(k) - static_cast<double>(other));
  }
  return weights;
}

/// Four neighbouring grid points and their interpolation weights.
struct Stencil {
  std::size_t first = 0;
  std::array<double, kDirectionsPerSide> weights{};
};

/// Returns the interpolation stencil at a position.
/// \param place position in steps from the first of `count` grid points
Stencil stencil_at(double place, std::size_t count) {
  Stencil stencil;
  const double first = std::clamp(std::floor(place) - 1.0, 0.0, static_cast<double>(count - kDirectionsPerSide));
  stencil.first = static_cast<std::size_t>(first);
  stencil.weights = cubic_weights(place - first);
  return stencil;
}

bool holds(const std::array<Angle, 2>& range, double rad) {
  return range[0].rad() - kSlackRad <= rad && rad <= range[1].rad() + kSlackRad;
}

double thirds_of(const std::array<Angle, 2>& range, double rad) {
  return 3.0 * (rad - range[0].rad()) / (range[1].rad() - range[0].rad());
}

}  // namespace

double luminous(const Rgb& rgb) {
  return srgb_luminance(rgb);
}

Vec2 ReflectionTable::deviation(std::size_t index) const {
  return Vec2(static_cast<double>(index % columns), static_cast<double>(index / columns)) * step() -
         Vec2::Constant(half_width);
}

std::array<Angle, 2> ReflectionTable::azimuths() const {
  const double from_deg = mirrors[0] && !mirrors[1] ? -90.0 : 0.0;
  const double span_deg = mirrors[0] && mirrors[1] ? 90.0 : mirrors[0] || mirrors[1] ? 180.0 : 360.0;
  return {Angle::from_deg(from_deg), Angle::from_deg(from_deg + span_deg)};
}

std::optional<ReflectionTable::Weighted> ReflectionTable::at(const Vec3& to_source) const {
  Weighted found;
  Vec2 folded = to_source.head<2>();
  for (const Eigen::Index axis : {0, 1})
    if (mirrors[static_cast<std::size_t>(axis)] && folded[axis] < 0.0) found.signs[axis] = -1.0;
  folded = folded.cwiseProduct(found.signs);
  const double entrance = std::atan2(folded.norm(), to_source.z());
  double azimuth = folded.norm() > 0.0 ? std::atan2(folded.y(), folded.x()) : azimuths()[0].rad();
  if (azimuth < azimuths()[0].rad() - kSlackRad) azimuth += 2.0 * std::numbers::pi;
  for (const Cell& cell : cells) {
    if (!holds(cell.entrance, entrance) || !holds(cell.azimuth, azimuth)) continue;
    const auto along = cubic_weights(thirds_of(cell.entrance, entrance));
    const auto round = cubic_weights(thirds_of(cell.azimuth, azimuth));
    found.directions = cell.directions;
    for (std::size_t k = 0; k < found.weights.size(); ++k)
      found.weights[k] = round[k / kDirectionsPerSide] * along[k % kDirectionsPerSide];
    return found;
  }
  return std::nullopt;
}

Rgb ReflectionTable::between(const std::vector<Rgb>& grid, const Vec2& deviation) const {
  const Vec2 place = (deviation + Vec2::Constant(half_width)) / step();
  const Stencil x = stencil_at(place.x(), columns);
  const Stencil y = stencil_at(place.y(), columns);
  Rgb sum{};
  for (std::size_t j = 0; j < kDirectionsPerSide; ++j)
    for (std::size_t i = 0; i < kDirectionsPerSide; ++i) {
      const Rgb& value = grid[(y.first + j) * columns + x.first + i];
      for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += y.weights[j] * x.weights[i] * value[band];
    }
  return sum;
}

std::optional<Rgb> ReflectionTable::r_a(const Vec3& to_source, const Vec3& to_observer) const {
  const std::optional<Weighted> among = at(to_source);
  const Vec2 deviation = to_observer.head<2>() - central_direction(to_source);
  if (!among || deviation.cwiseAbs().maxCoeff() > half_width) return std::nullopt;
  Rgb sum{};
  for (std::size_t k = 0; k < among->directions.size(); ++k) {
    const Rgb value = between(directions[among->directions[k]].r_a, deviation.cwiseProduct(among->signs));
    for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += among->weights[k] * value[band];
  }
  return sum;
}

double ReflectionTable::returned(const Vec3& to_source) const {
  double sum = 0.0;
  for_each_power(to_source, [&](const Vec2&, double share) { sum += share; });
  return sum;
}

}  // namespace retrace::studies
