#include "studies/ranging/aberration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/angle.h"
#include "raytrace/light/aperture_kernel.h"

namespace retrace::studies {
namespace {

using geometry::Vec2;

// Gravitational constant times the mass of the Earth (IERS Conventions 2010, Table 1.1).
constexpr double kEarthKm3PerS2 = 398600.4418;
// Equatorial radius of the Earth (IERS Conventions 2010, Table 1.1).
constexpr double kEarthRadiusKm = 6378.1366;
constexpr double kLightKmPerS = 1e6 * kLightMmPerPs;

// Number of integration points per angular width of the finest details.
constexpr double kPointsPerDetail = 3.0;
// Number of integration points that are added, so that small annuli also have enough points.
constexpr double kMorePoints = 6.0;
// Number of sample rings, and of samples along each ring, per angular width of the finest details. The samples are the
// starts of the search for extremes.
constexpr double kSearchPerDetail = 6.0;
// The search for an extreme ends after this number of steps. Each step that finds no larger value is halved.
constexpr int kHalvings = 20;

Vec2 at(double radius, double angle) {
  return radius * Vec2(std::cos(angle), std::sin(angle));
}

std::size_t count_of(double periods) {
  return static_cast<std::size_t>(std::ceil(periods));
}

/// Numbers of rings and of points along each ring.
struct RingCounts {
  std::size_t rings = 1;
  std::size_t around = 1;
};

/// Returns the numbers of integration points over an annulus.
RingCounts integration_counts(const Annulus& annulus, double detail_rad) {
  const double width = annulus.outer_rad - annulus.inner_rad;
  return {width > 0.0 ? count_of(kPointsPerDetail * width / detail_rad + kMorePoints) : 1,
          count_of(kPointsPerDetail * kTwoPi * annulus.outer_rad / detail_rad + kMorePoints)};
}

/// Returns the numbers of samples over an annulus among which its extremes are searched.
RingCounts search_counts(const Annulus& annulus, double detail_rad) {
  const double width = annulus.outer_rad - annulus.inner_rad;
  return {width > 0.0 ? 1 + count_of(kSearchPerDetail * width / detail_rad) : 1,
          count_of(kSearchPerDetail * kTwoPi * annulus.outer_rad / detail_rad + kMorePoints)};
}

/// Point in polar coordinates.
struct PolarPoint {
  double radius = 0.0;
  double angle = 0.0;
};

/// Returns the largest value of a function near a point. The pattern search tries four neighbours and halves its step
/// if none of them has a larger value.
double refined_max(const Annulus& annulus, PolarPoint best, double value, double step_rad,
                   const DirectionValues& values) {
  double radial = step_rad;
  double around = step_rad / std::max(annulus.outer_rad, step_rad);
  for (int k = 0; k < kHalvings; ++k) {
    const std::array<PolarPoint, 4> tried = {{{std::min(best.radius + radial, annulus.outer_rad), best.angle},
                                              {std::max(best.radius - radial, annulus.inner_rad), best.angle},
                                              {best.radius, best.angle + around},
                                              {best.radius, best.angle - around}}};
    std::vector<Vec2> angles;
    for (const PolarPoint& p : tried) angles.push_back(at(p.radius, p.angle));
    const std::vector<double> found = values(angles);
    const auto highest = std::max_element(found.begin(), found.end());
    if (*highest > value) {
      value = *highest;
      best = tried[static_cast<std::size_t>(highest - found.begin())];
    } else {
      radial *= 0.5;
      around *= 0.5;
    }
  }
  return value;
}

}  // namespace

Annulus aberration_of_orbit(double height_km, double elevation_deg) {
  const double radius_km = kEarthRadiusKm + height_km;
  const double largest = 2.0 * std::sqrt(kEarthKm3PerS2 / radius_km) / kLightKmPerS;
  // Sine of the angle at the satellite between the directions to the station and to the centre of the Earth.
  const double sine = kEarthRadiusKm / radius_km * std::cos(elevation_deg * kRadPerDeg);
  return {largest * std::sqrt(1.0 - sine * sine), largest};
}

std::vector<AnnulusPoint> annulus_points(const Annulus& annulus, double detail_rad) {
  const double width = annulus.outer_rad - annulus.inner_rad;
  if (annulus.outer_rad == 0.0) return {{Vec2::Zero(), 1.0}};
  const auto [rings, around] = integration_counts(annulus, detail_rad);
  const raytrace::GaussRule rule = rings > 1 ? raytrace::gauss_legendre(rings) : raytrace::GaussRule{{0.5}, {1.0}};
  std::vector<AnnulusPoint> points;
  double sum = 0.0;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double radius = annulus.inner_rad + width * rule.nodes[ring];
    for (std::size_t k = 0; k < around; ++k) {
      const double weight = radius * rule.weights[ring];
      points.push_back({at(radius, kTwoPi * static_cast<double>(k) / static_cast<double>(around)), weight});
      sum += weight;
    }
  }
  for (AnnulusPoint& point : points) point.weight /= sum;
  return points;
}

double evaluations_over(const Annulus& annulus, double detail_rad) {
  if (annulus.outer_rad == 0.0) return 1.0;
  const RingCounts mean = integration_counts(annulus, detail_rad);
  const RingCounts search = search_counts(annulus, detail_rad);
  return static_cast<double>(mean.rings) * static_cast<double>(mean.around) +
         static_cast<double>(search.rings) * static_cast<double>(search.around);
}

AnnulusStatistics statistics_over(const Annulus& annulus, double detail_rad, const DirectionValues& values) {
  AnnulusStatistics statistics;
  const std::vector<AnnulusPoint> points = annulus_points(annulus, detail_rad);
  std::vector<Vec2> angles;
  for (const AnnulusPoint& point : points) angles.push_back(point.angles_rad);
  const std::vector<double> of_points = values(angles);
  for (std::size_t k = 0; k < points.size(); ++k) statistics.mean += points[k].weight * of_points[k];
  if (annulus.outer_rad == 0.0) return {statistics.mean, statistics.mean, statistics.mean};
  const double width = annulus.outer_rad - annulus.inner_rad;
  const auto [rings, around] = search_counts(annulus, detail_rad);
  std::vector<PolarPoint> searched;
  angles.clear();
  for (std::size_t ring = 0; ring < rings; ++ring)
    for (std::size_t k = 0; k < around; ++k) {
      const double share = rings > 1 ? static_cast<double>(ring) / static_cast<double>(rings - 1) : 0.0;
      searched.push_back(
          {annulus.inner_rad + share * width, kTwoPi * static_cast<double>(k) / static_cast<double>(around)});
      angles.push_back(at(searched.back().radius, searched.back().angle));
    }
  const std::vector<double> found = values(angles);
  const auto [low, high] = std::minmax_element(found.begin(), found.end());
  const double step_rad = detail_rad / kSearchPerDetail;
  const auto place = [&](auto extreme) { return searched[static_cast<std::size_t>(extreme - found.begin())]; };
  statistics.max = refined_max(annulus, place(high), *high, step_rad, values);
  const DirectionValues negative = [&](const std::vector<Vec2>& where) {
    std::vector<double> result = values(where);
    for (double& value : result) value = -value;
    return result;
  };
  statistics.min = -refined_max(annulus, place(low), -*low, step_rad, negative);
  return statistics;
}

}  // namespace retrace::studies
