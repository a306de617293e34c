#pragma once

// Velocity aberration. Also computes statistics of a function of direction over the annulus of velocity aberration.

#include <cstddef>
#include <functional>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

inline constexpr double kLightMmPerPs = 0.299792458;  ///< speed of light in vacuum

/// Directions whose angle from the direction to the source is between two limits.
struct Annulus {
  double inner_rad = 0.0;
  double outer_rad = 0.0;
};

/// Returns the minimum and the maximum of the velocity aberration 2 v / c of a satellite on a circular orbit, for all
/// stations on the ground. The rotation of the Earth is neglected.
/// \param height_km height of the orbit above the equator
/// \param elevation_deg minimum elevation of the satellite at the station
Annulus aberration_of_orbit(double height_km, double elevation_deg);

/// Direction, given by angles to the right and up, with its weight in a mean over solid angle.
struct AnnulusPoint {
  geometry::Vec2 angles_rad = geometry::Vec2::Zero();
  double weight = 0.0;
};
/// Returns integration points of an annulus. The weights add up to 1.
/// \param detail_rad width of the finest details of the integrand, > 0
std::vector<AnnulusPoint> annulus_points(const Annulus& annulus, double detail_rad);

/// Mean and extremes of a function over an annulus.
struct AnnulusStatistics {
  double mean = 0.0;
  double min = 0.0;
  double max = 0.0;
};
/// Function that returns one value for each direction, given by angles to the right and up in rad.
using DirectionValues = std::function<std::vector<double>(const std::vector<geometry::Vec2>& angles_rad)>;
/// Returns the number of directions that statistics_over() evaluates before its local search.
double evaluations_over(const Annulus& annulus, double detail_rad);
/// Computes the mean and the extremes of a function over an annulus. The extremes are first found among samples and
/// then refined by a local search.
AnnulusStatistics statistics_over(const Annulus& annulus, double detail_rad, const DirectionValues& values);

}  // namespace retrace::studies
