#pragma once

// Internal to geometry. Builds the back surface of a part from cells on a plane or on a substrate.

#include <cstdint>
#include <vector>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/facet_planes.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Adds the patches, placements and counts of a finite array to a part whose specification and size are set. The
/// surface has exactly one height at each (x, y). In plan, each cell ends at the polygon through its corners, and
/// vertical walls connect neighbours of different height.
/// \param planes individual facet planes of elements; null: all elements are as specified
/// \param elements_per_patch maximum number of elements in a single patch; larger arrays are built from shared blocks
///     with at most this number
/// \throw InputError if elements on a substrate do not cover the part
void add_array(Part& part, const ArraySheet& sheet, const FacetPlanes* planes, const Vec2& origin_mm,
               double elements_per_patch);

/// Tiles of a finite array whose extent begins at the origin.
struct ArrayTiles {
  std::vector<Tile> tiles;
  std::int64_t full = 0;  ///< number of complete elements
  std::int64_t partial = 0;
};
/// Returns the tiles of an array.
/// \pre the array is finite, on the plane z = 0 and not `single`
/// \throw InputError if the array is smaller than one element
ArrayTiles array_tiles(const PartSpec& spec);

/// Returns the tiles of some cells of an array. Cells are complete, even if they cross the border.
/// \param cells numbers of the cells (ArrayCell), ascending
/// \pre the array is finite, on the plane z = 0 and not `single`
std::vector<Tile> uncut_tiles(const PartSpec& spec, const std::vector<std::uint32_t>& cells);

/// Adds some periods of an infinite array.
void add_periods(Part& part, const ArraySheet& sheet);

/// Adds a single element.
void add_single(Part& part, const FacetPlanes* planes, const Vec2& origin_mm);

}  // namespace retrace::geometry
