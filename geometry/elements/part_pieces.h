#pragma once

// Internal to geometry: what parts on the plane z = 0 and on bases are made of alike.

#include <array>
#include <cstdint>

#include "geometry/elements/lattice.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// Up to this many elements the surface is one patch; beyond, blocks of at most this many are shared.
inline constexpr double kElementsPerPatch = 2048.0;
/// Lengths this close to a whole number of elements (relative) are whole.
inline constexpr double kWholeTolerance = 1e-9;

/// Range of lattice indices, upper bounds excluded.
struct IndexRange {
  std::array<std::int64_t, 2> lower{};
  std::array<std::int64_t, 2> upper{};
};

/// The indices of all cells of the lattice, its origin at `anchor`, that may reach into the extent.
IndexRange indices_over(const Lattice& lattice, const Rectangle& extent, const Vec2& anchor);

/// The errors of the element at (i, j), the `number`th of the period: those of all, and its own random tilts.
AngleErrors errors_of(const PartSpec& spec, std::int64_t i, std::int64_t j, std::uint32_t number);

/// The four strips of the extent that the block leaves free; any of them may be empty.
std::array<Rectangle, 4> margins(const Rectangle& extent, const Rectangle& block);

Polygon moved(const Polygon& polygon, const Vec2& by);
Vec2 middle_of(const Polygon& outline);

}  // namespace retrace::geometry
