#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "surface_models/height_map.h"

// Height maps with known statistics: white noise, Gaussian roughness, waves and planes.

namespace retrace::testing {

/// Returns independent Gaussian heights of variance 1 on a grid with a spacing of 1 um.
inline surface_models::HeightMap white_noise(std::size_t columns, std::size_t rows, std::uint32_t seed) {
  surface_models::HeightMap map{columns, rows, 1.0, 1.0, std::vector<double>(columns * rows)};
  for (std::size_t i = 0; i < map.heights_nm.size(); ++i) {
    const auto words = philox({seed, 0}, static_cast<std::uint32_t>(i), 0);
    const double radius = std::sqrt(-2.0 * std::log1p(-unit_interval(words[0])));
    map.heights_nm[i] = radius * std::cos(2.0 * std::numbers::pi * unit_interval(words[1]));
  }
  return map;
}

/// Returns periodic Gaussian heights with the autocorrelation sq^2 exp(-(distance / length)^2). They are the direct
/// convolution of white noise with the kernel exp(-2 (distance / length)^2).
inline surface_models::HeightMap gaussian_surface(std::size_t columns, std::size_t rows, double sq_nm, double length_um,
                                                  std::uint32_t seed) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(2.2 * length_um));
  std::vector<double> kernel;
  double squares = 0.0;
  for (std::ptrdiff_t i = -reach; i <= reach; ++i) {
    const double t = static_cast<double>(i) / length_um;
    kernel.push_back(std::exp(-2.0 * t * t));
    squares += kernel.back() * kernel.back();
  }
  const auto smoothed = [&](const surface_models::HeightMap& map, std::size_t dx, std::size_t dy) {
    surface_models::HeightMap result = map;
    for (std::size_t row = 0; row < map.rows; ++row)
      for (std::size_t column = 0; column < map.columns; ++column) {
        double sum = 0.0;
        for (std::size_t k = 0; k < kernel.size(); ++k)
          sum += kernel[k] * map.at((column + k * dx) % map.columns, (row + k * dy) % map.rows);
        result.at(column, row) = sum / std::sqrt(squares);
      }
    return result;
  };
  surface_models::HeightMap map = smoothed(white_noise(columns, rows, seed), 1, 0);
  if (rows > 1) map = smoothed(map, 0, 1);
  for (double& z : map.heights_nm) z *= sq_nm;
  return map;
}

/// Adds the wave sqrt(2) sq sin(2 pi (fx x + fy y) + phase), which has the root mean square height sq.
inline void add_wave(surface_models::HeightMap& map, double sq_nm, double fx_per_um, double fy_per_um,
                     double phase = 0.0) {
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double turns = fx_per_um * static_cast<double>(column) * map.x_pixel_um +
                           fy_per_um * static_cast<double>(row) * map.y_pixel_um;
      map.at(column, row) += std::numbers::sqrt2 * sq_nm * std::sin(2.0 * std::numbers::pi * turns + phase);
    }
}

/// Adds a plane that rises by the given amounts over the map; negative amounts fall.
inline void add_plane(surface_models::HeightMap& map, double offset_nm, double x_rise_nm, double y_rise_nm) {
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column)
      map.at(column, row) += offset_nm + x_rise_nm * static_cast<double>(column) / static_cast<double>(map.columns) +
                             y_rise_nm * static_cast<double>(row) / static_cast<double>(map.rows);
}

}  // namespace retrace::testing
