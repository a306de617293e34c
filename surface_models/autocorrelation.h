#pragma once

// Autocorrelation of a height map, and the correlation length of its roughness.

#include <cstddef>
#include <optional>
#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Autocorrelation: mean product of the heights at two points as a function of their distance (dx, dy). The mean is
/// over all pairs of measured points (unbiased estimator). Missing points are ignored.
struct Autocorrelation {
  std::size_t x_lags = 0;  ///< number of distances along x; dx = 0..x_lags - 1 points
  std::size_t y_lags = 0;  ///< number of distances along y; |dy| = 0..y_lags - 1 points
  double x_pixel_um = 0.0;
  double y_pixel_um = 0.0;
  /// row by row, beginning with dy = -(y_lags - 1); NaN if no pair of points has this distance
  std::vector<double> values_nm2;

  double at(std::size_t dx, std::ptrdiff_t dy) const {
    return values_nm2[static_cast<std::size_t>(dy + static_cast<std::ptrdiff_t>(y_lags) - 1) * x_lags + dx];
  }
  double variance_nm2() const { return at(0, 0); }
};

/// Returns the autocorrelation of the deviations from the mean height.
/// \param max_um maximum distance along each axis; limited to half of the map
Autocorrelation autocorrelation(const HeightMap& map, double max_um);

/// Returns the smallest distance along `axis` at which the autocorrelation is 1/e of its value at distance 0,
/// interpolated between points. Returns nothing if the autocorrelation does not fall to this value, or if the surface
/// is flat.
std::optional<double> correlation_length_um(const Autocorrelation& r, Axis axis);

}  // namespace retrace::surface_models
