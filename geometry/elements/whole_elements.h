#pragma once

// Counts and places the elements of a finite array, on the plane z = 0 or on a substrate. Drawings, masks, tables of
// facets and jobs take it; parts have the same cells by the same sheet (array_sheet.h).

#include <cstdint>
#include <vector>

#include "geometry/elements/part_spec.h"
#include "geometry/polygon.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// Columns and rows of an array's cells.
struct CellCounts {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
};

/// How many elements have room on a length: lengths that are whole up to a relative 1e-9 are whole.
/// \param offset_mm margin at both ends \param pitch_mm from element to element, gap included
double whole_count(double length_mm, double offset_mm, double gap_mm, double pitch_mm);

/// The block of whole prisms, centred in the extent.
struct PrismBlock {
  CellCounts counts;
  Vec2 pitch_mm = Vec2::Zero();
  Rectangle filled;       ///< from the first element to the last, in the part's frame
  double shift_mm = 0.0;  ///< of alternate rows; 0: none is shifted
  RowParity shifted_rows = RowParity::even;
  bool is_checker = false;

  /// \param row from 0 at least y
  bool is_shifted(std::int64_t row) const;
  /// How many whole elements a row has.
  std::int64_t columns_of(std::int64_t row) const { return counts.columns - (is_shifted(row) ? 1 : 0); }
  /// Lower left corner of an element, in the part's frame.
  Vec2 corner_mm(std::int64_t row, std::int64_t column) const;
  /// Centre of an element, from the middle of the extent.
  Vec2 centre_mm(std::int64_t row, std::int64_t column) const;
  bool is_rotated(std::int64_t row, std::int64_t column) const { return is_checker && (row + column) % 2 == 1; }
};
/// \pre lengths and sizes > 0, the array is finite
PrismBlock prism_block(const ArrayLayout& array, const RtpElement& element);

/// An element that lies wholly within the array.
struct WholeElement {
  Vec2 centre_mm = Vec2::Zero();  ///< of a prism's aperture, of a cube corner's apex; from the middle of the extent
  std::int32_t row = 0;           ///< from 0, the row of least y
  std::int32_t column = 0;        ///< from 0, x rising
  bool is_rotated = false;        ///< a prism by 90 degrees about z, a cube corner by 180
  bool is_there = true;           ///< the array's pattern says so
};

/// What the borders leave of a cell.
enum class Standing { whole, cut, beyond };

/// An element where it stands.
struct PlacedElement {
  WholeElement on_sheet;  ///< on what the array is laid out on: the plane, or the substrate rolled out
  Standing standing = Standing::whole;
  SubstrateFrame frame;  ///< under its middle or apex, from the part's middle; z = 0 is the substrate's highest place
};

/// All elements that are not beyond the border, row by row from least y, x rising; a pattern is not asked. Prisms are
/// numbered by their places on the sheet, the whole ones of cube corners one by one.
/// \pre a finite array that is not `single` \throw InputError where the array is smaller than one element
std::vector<PlacedElement> place(const PartSpec& spec);

/// The whole ones of a flat array, in the same order. Prisms fill a block that is centred; of cube corners an apex that
/// is not rotated lies in the middle of the extent, or of `single` in the middle of the aperture's box (CONVENTIONS.md,
/// section 3). \pre the array is finite, a pattern has its rows and cells
std::vector<WholeElement> whole_elements(const ArrayLayout& array, const Element& element);

/// How many of them each row has, from that of least y; as the rows of a pattern have places.
std::vector<std::int64_t> row_lengths(const ArrayLayout& array, const Element& element);

/// About how many cells the array has, without going through them.
double element_estimate(const ArrayLayout& array, const Element& element);

}  // namespace retrace::geometry
