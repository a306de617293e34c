#pragma once

#include <cstdint>
#include <vector>

#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// A cube corner of an array that lies wholly within it, in the part's frame.
struct CubeCell {
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();  ///< of its apex, from the middle of the array's extent
  std::int32_t row = 0;                               ///< from 0, the row of least y
  std::int32_t column = 0;                            ///< from 0, x rising
  bool rotated = false;                               ///< by 180 degrees about z
  bool is_cut = true;                                 ///< the array's pattern says so
};

/// All of them, row by row from least y, x rising. An apex of an unturned cell lies in the middle of the extent of
/// arrays (CONVENTIONS.md, section 3); of `single` the middle of the aperture's box does.
/// \pre the element is a cube corner, the array is finite, a pattern has the array's rows and cells
std::vector<CubeCell> cube_cells(const Array& array, const geometry::Element& element);

/// Of how many whole cells each row consists, from the row of least y.
std::vector<std::int64_t> cube_row_lengths(const Array& array, const geometry::Element& element);

/// About how many cells the array has, without going through them.
double cube_cell_estimate(const Array& array, const geometry::Element& element);

}  // namespace retrace::fabrication
