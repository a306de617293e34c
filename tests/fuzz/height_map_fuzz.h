#pragma once

// For any file, a reader of height maps either returns a map that satisfies its postconditions or throws an InputError
// of one line.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "surface_models/io/height_map_reader.h"
#include "tests/fuzz/one_line.h"

namespace retrace::fuzz {

/// Reads a height map.
/// \param begin bytes that are put in front of the fuzz input, so that the reader of one format is selected
/// \param name file name, whose extension may select the format
inline void read_height_map(const std::string& begin, const std::uint8_t* data, std::size_t size,
                            const std::string& name) {
  const std::string content = begin + std::string(data, data + size);
  try {
    const surface_models::HeightMap map = surface_models::parse_height_map(content, name, {}).map;
    const bool is_sound =
        map.columns >= surface_models::kMinColumns && map.rows >= 1 &&
        map.columns * map.rows == map.heights_nm.size() && map.x_pixel_um > 0.0 && map.y_pixel_um > 0.0 &&
        std::none_of(map.heights_nm.begin(), map.heights_nm.end(), [](double z) { return std::isinf(z); });
    if (!is_sound) std::abort();
  } catch (const InputError& error) {
    require_one_line(error);
  }
}

}  // namespace retrace::fuzz
