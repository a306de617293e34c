#include "surface_models/height_map.h"

#include <algorithm>
#include <cmath>

namespace retrace::surface_models {

std::size_t measured_points(const HeightMap& map) {
  return static_cast<std::size_t>(
      std::count_if(map.heights_nm.begin(), map.heights_nm.end(), [](double z) { return std::isfinite(z); }));
}

HeightMap rotated_by_90_degrees(const HeightMap& map) {
  HeightMap turned{map.rows, map.columns, map.y_pixel_um, map.x_pixel_um, {}};
  turned.heights_nm.resize(map.heights_nm.size());
  for (std::size_t row = 0; row < turned.rows; ++row)
    for (std::size_t column = 0; column < turned.columns; ++column)
      turned.at(column, row) = map.at(map.columns - 1 - row, column);
  return turned;
}

HeightMap cropped(const HeightMap& map, double x_um, double y_um) {
  const auto points = [](double length_um, double pixel_um) {
    return static_cast<std::size_t>(std::ceil(length_um / pixel_um));
  };
  const std::size_t left = points(x_um, map.x_pixel_um);
  const std::size_t top = map.is_profile() ? 0 : points(y_um, map.y_pixel_um);
  HeightMap inner{map.columns - 2 * left, map.rows - 2 * top, map.x_pixel_um, map.y_pixel_um, {}};
  inner.heights_nm.reserve(inner.columns * inner.rows);
  for (std::size_t row = top; row < top + inner.rows; ++row)
    for (std::size_t column = left; column < left + inner.columns; ++column)
      inner.heights_nm.push_back(map.at(column, row));
  return inner;
}

}  // namespace retrace::surface_models
