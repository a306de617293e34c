#pragma once

// Picture behind the part in a camera picture.

#include <array>
#include <cstddef>
#include <vector>

namespace retrace::studies {

/// A picture in linear light, row by row from the top.
struct Background {
  std::size_t columns = 0;
  std::size_t rows = 0;
  /// Red, green and blue in linear sRGB: in cd/m^2 if `is_luminance`, otherwise relative to the white of the picture.
  std::vector<std::array<float, 3>> rgb;
  bool is_luminance = false;

  /// Returns the mean colour of the background behind a pixel of another picture. The background is scaled to cover the
  /// other picture completely. The centres of both coincide, and parts of the background beyond the other picture are
  /// cut off.
  std::array<double, 3> mean_colour(std::size_t pixel, std::size_t picture_columns, std::size_t picture_rows) const;
};

}  // namespace retrace::studies
