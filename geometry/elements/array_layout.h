#pragma once

// Describes how elements are repeated over a part: arrangement, gaps, offsets, shifted rows, partial elements. Designs
// and fabrication jobs use the same description.

#include <memory>
#include <string>
#include <vector>

namespace retrace::geometry {

struct PlanRegion;

enum class Arrangement { single, aligned, offset, checker, honeycomb, triangular, ruled };
enum class Extent { finite, infinite };
/// Parity of the rows of an offset array that are shifted. Rows are counted from 1 at y = 0. An array with a single row
/// is never shifted.
enum class RowParity { even, odd };
/// Treatment of an element that the border crosses.
enum class PartialElements { cut, omit };

/// Layout of an array. Lengths are in mm in the part frame. Fabrication jobs cut complete elements of finite arrays.
struct ArrayLayout {
  Arrangement arrangement = Arrangement::aligned;
  Extent extent = Extent::finite;
  RowParity shifted_rows = RowParity::even;
  PartialElements partial_elements = PartialElements::cut;
  double x_length_mm = 0.0;  ///< lengths of the array along x and y; used only for finite arrays that are not `single`
  double y_length_mm = 0.0;
  double x_gap_mm = 0.0;  ///< width of the flat land (surface without elements) between elements; prisms only
  double y_gap_mm = 0.0;
  double x_offset_mm = 0.0;  ///< width of the flat margin without elements at both ends along x
  double y_offset_mm = 0.0;
  double overlap_percent = 50.0;  ///< shift of alternate rows of `offset`, in percent of the base
  /// Mask of complete elements. There is one text per row, beginning with the row of largest y. The characters of a row
  /// are in the order of ascending x. '#' marks an element that exists, '-' marks an element that is missing. An empty
  /// mask means that all elements exist. The last column of a shifted row is beyond the border and is ignored. A row of
  /// cube corners has as many characters as there are complete cells at the y of this row.
  std::vector<std::string> pattern;
  /// Outline of a part that is not a rectangle parallel to the axes, or null. The array fills the bounding box of the
  /// outline, which has the lengths `x_length_mm` and `y_length_mm`. The outline then cuts the array. `x_offset_mm` and
  /// `y_offset_mm` are equal to the width of the outline's margin.
  std::shared_ptr<const PlanRegion> outline;
};

}  // namespace retrace::geometry
