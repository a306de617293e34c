#pragma once

// How elements are repeated over a part - arrangement, gaps, offsets, shifted rows, partial elements: what designs and
// fabrication jobs say alike.

#include <string>
#include <vector>

namespace retrace::geometry {

enum class Arrangement { single, aligned, offset, checker, honeycomb, triangular };
enum class Extent { finite, infinite };
/// Which rows of an offset array are shifted; rows count from 1 at y = 0. A single row is never shifted.
enum class RowParity { even, odd };
/// What becomes of an element that the border crosses.
enum class PartialElements { cut, omit };

/// Lengths in mm in the part frame. Jobs cut whole elements of finite arrays.
struct ArrayLayout {
  Arrangement arrangement = Arrangement::aligned;
  Extent extent = Extent::finite;
  RowParity shifted_rows = RowParity::even;
  PartialElements partial_elements = PartialElements::cut;
  double x_length_mm = 0.0;  ///< of the extent of finite arrays that are not `single`
  double y_length_mm = 0.0;
  double x_gap_mm = 0.0;  ///< flat land between elements; prisms only
  double y_gap_mm = 0.0;
  double x_offset_mm = 0.0;  ///< flat margin kept free on both borders
  double y_offset_mm = 0.0;
  double overlap_percent = 50.0;  ///< shift of alternate rows of `offset`, in percent of the base
  /// Which whole elements are there: one text a row, the row of largest y first, '#' for one that is there and '-' for
  /// one that is not, x rising. Empty: all are. The last column of a shifted row lies beyond the border and counts for
  /// nothing. Of cube corners a row has as many cells as lie wholly within the array at its height.
  std::vector<std::string> pattern;
};

}  // namespace retrace::geometry
