#pragma once

// Internal to geometry: builds the back surface of a part from cells that stand on a plane or on a substrate.

#include <cstdint>
#include <vector>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/facet_planes.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Adds patches, placements and counts of a finite array to a part that knows its specification and size. Seen along z
/// the surface is one height at every place: cells end where the plan of their corners does, and vertical walls close
/// what differs between neighbours. \param planes of elements that have their own; null: all are the specification's
/// \param elements_per_patch up to this many the surface is one patch; beyond, blocks of at most this many are shared
/// \throw InputError if elements on a substrate do not cover the part
void add_array(Part& part, const ArraySheet& sheet, const FacetPlanes* planes, const Vec2& origin_mm,
               double elements_per_patch);

/// What stands on an array's extent, which begins at the origin.
struct ArrayTiles {
  std::vector<Tile> tiles;
  std::int64_t full = 0;  ///< elements
  std::int64_t partial = 0;
};
/// \pre a finite array on the plane z = 0, not `single` \throw InputError where it is smaller than one element
ArrayTiles array_tiles(const PartSpec& spec);

/// The tiles of some cells of that array, each as if it stood alone: what reaches over the border is not cut.
/// \param cells their numbers (ArrayCell), rising \pre likewise
std::vector<Tile> uncut_tiles(const PartSpec& spec, const std::vector<std::uint32_t>& cells);

/// Adds an infinite array: some periods of it.
void add_periods(Part& part, const ArraySheet& sheet);

/// Adds an element by itself.
void add_single(Part& part, const FacetPlanes* planes, const Vec2& origin_mm);

}  // namespace retrace::geometry
