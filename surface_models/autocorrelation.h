#pragma once

// Autocorrelation of a height map and the correlation length of its roughness.

#include <cstddef>
#include <optional>
#include <vector>

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// The mean product of heights at two places against their distance (dx, dy), over all pairs of measured points
/// (unbiased; missing points take part in no pair).
struct Autocorrelation {
  std::size_t x_lags = 0;  ///< dx = 0..x_lags - 1 points
  std::size_t y_lags = 0;  ///< |dy| = 0..y_lags - 1 points
  double x_pixel_um = 0.0;
  double y_pixel_um = 0.0;
  std::vector<double> values_nm2;  ///< dy = -(y_lags - 1) first; NaN where no pair has that distance

  double at(std::size_t dx, std::ptrdiff_t dy) const {
    return values_nm2[static_cast<std::size_t>(dy + static_cast<std::ptrdiff_t>(y_lags) - 1) * x_lags + dx];
  }
  double variance_nm2() const { return at(0, 0); }
};

/// Autocorrelation of the deviations from the mean height, up to `most_um` along each axis, at most to half the map.
Autocorrelation autocorrelation(const HeightMap& map, double most_um);

/// The distance along `axis` at which the autocorrelation first falls to 1/e of its value at 0, interpolated between
/// points. Nothing if it does not within its range, or if the surface is flat.
std::optional<double> correlation_length_um(const Autocorrelation& r, Axis axis);

}  // namespace retrace::surface_models
