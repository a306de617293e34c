#pragma once

// Counts and places the elements of a finite array, on the plane z = 0 or on a substrate. Drawings, masks, tables of
// facets and fabrication jobs use these functions. The elements agree with the cells of a part, because parts are built
// from the same sheet (array_sheet.h).

#include <cstdint>
#include <vector>

#include "geometry/elements/part_spec.h"
#include "geometry/polygon.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// Numbers of columns and rows of an array's cells.
struct CellCounts {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
};

/// Returns the number of elements that fit into a length. Lengths within 1e-9 (relative) of a whole number of elements
/// count as whole.
/// \param offset_mm margin at both ends
/// \param pitch_mm distance between elements, including the gap
double whole_count(double length_mm, double offset_mm, double gap_mm, double pitch_mm);

/// Block of the complete prisms, centred in the extent of the array.
struct PrismBlock {
  CellCounts counts;
  Vec2 pitch_mm = Vec2::Zero();
  Rectangle filled;       ///< from the first element to the last, in the part frame
  double shift_mm = 0.0;  ///< shift of alternate rows; 0 if no row is shifted
  RowParity shifted_rows = RowParity::even;
  bool is_checker = false;

  /// Returns true if a row is shifted.
  /// \param row counted from 0 at the smallest y
  bool is_shifted(std::int64_t row) const;
  /// Returns the number of complete elements in a row.
  std::int64_t columns_of(std::int64_t row) const { return counts.columns - (is_shifted(row) ? 1 : 0); }
  /// Returns the lower left corner of an element, in the part frame.
  Vec2 corner_mm(std::int64_t row, std::int64_t column) const;
  /// Returns the centre of an element, relative to the centre of the extent.
  Vec2 centre_mm(std::int64_t row, std::int64_t column) const;
  bool is_rotated(std::int64_t row, std::int64_t column) const { return is_checker && (row + column) % 2 == 1; }
};
/// Returns the block of prisms of an array.
/// \pre lengths and sizes > 0, the array is finite
PrismBlock prism_block(const ArrayLayout& array, const RtpElement& element);

/// An element that is completely within the array.
struct WholeElement {
  /// centre of a prism's aperture or apex of a cube corner, relative to the centre of the extent
  Vec2 centre_mm = Vec2::Zero();
  std::int32_t row = 0;     ///< counted from 0 at the smallest y
  std::int32_t column = 0;  ///< counted from 0 in the direction of ascending x
  /// true for a prism rotated by 90 degrees about z, or a cube corner rotated by 180 degrees
  bool is_rotated = false;
  bool is_there = true;  ///< false if the array's pattern omits the element
};

/// Position of a cell relative to the border: inside, cut by the border, or outside.
enum class BorderRelation { inside, crossing, outside };

/// Position and orientation of an element in the part.
struct PlacedElement {
  WholeElement on_sheet;  ///< position on the sheet: the plane, or the substrate unrolled into a plane
  BorderRelation border_relation = BorderRelation::inside;
  /// frame on the substrate below the element's centre or apex, relative to the centre of the part; z = 0 is the
  /// highest point of the substrate
  SubstrateFrame frame;
};

/// Returns all elements that are not outside the border, sorted by row (ascending y), and within a row by ascending x.
/// The pattern is ignored. The row and column numbers of prisms count all positions on the sheet. The numbers of cube
/// corners count only complete elements.
/// \pre the array is finite and not `single`
/// \throw InputError if the array is smaller than one element
std::vector<PlacedElement> place_elements(const PartSpec& spec);

/// Returns the complete elements of a flat array, in the order of place_elements(). Prisms fill a block in the centre
/// of the extent. For cube corners, the apex of an element that is not rotated is at the centre of the extent. For
/// `single`, the centre of the aperture's bounding box is at the centre of the extent (CONVENTIONS.md, section 3).
/// \pre the array is finite; the pattern has the array's numbers of rows and cells
std::vector<WholeElement> whole_elements(const ArrayLayout& array, const Element& element);

/// Returns the number of complete elements in each row, beginning with the smallest y. These are the required lengths
/// of the rows of ArrayLayout::pattern.
std::vector<std::int64_t> row_lengths(const ArrayLayout& array, const Element& element);

/// Returns the approximate number of cells of the array, without visiting them.
double element_estimate(const ArrayLayout& array, const Element& element);

}  // namespace retrace::geometry
