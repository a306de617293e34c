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

  /// Returns the mean colour of a pixel of another picture, which the background covers completely. The centres of both
  /// pictures coincide, and what does not fit is cut off.
  std::array<double, 3> seen(std::size_t pixel, std::size_t columns, std::size_t rows) const;
};

}  // namespace retrace::studies
