#pragma once

// Checks that triangles cover a convex outline exactly once. Reports the first position where they do not.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Fault at a position at which adjacent triangles of a mesh do not join correctly.
enum class TilingFault {
  hole,
  overlap,
  height_jump,
  corner_on_side,     ///< a corner of a triangle is located on a side of another triangle, between its ends
  no_area,            ///< a triangle has zero area
  vertical_triangle,  ///< a triangle is vertical: its normal is perpendicular to z
  overhang,           ///< a triangle faces -z although it has the same orientation as its neighbour across a side
  reversed_triangle   ///< a triangle lists its corners in the opposite orientation to its neighbour
};

/// Returns a clause for messages that describes the fault, such as "there is a hole".
std::string_view text_of(TilingFault fault);

/// Position at which the triangles are not continuous.
struct TilingGap {
  TilingFault fault = TilingFault::hole;
  Vec2 at_mm = Vec2::Zero();
};

/// Checks that triangles, all of which face +z, are continuous across their sides within a convex outline.
///
/// Each side inside the outline must be traversed equally often in both directions by the triangles that contain it.
/// Every point inside the outline is then covered by the same number of triangles. Heights are continuous, because
/// adjacent triangles share their corners in three dimensions. The function does not check that the number of covering
/// triangles is 1. The caller checks this: the total area of the triangles within the outline, in plan view, must equal
/// the area of the outline.
/// \param sheet triangles to check, as indices of `vertices`
/// \param mesh all triangles of the mesh; they are used to determine the kind of the fault
/// \param tolerance_mm tolerance in mm: sides closer to the outline than this are not checked, and corners closer to a
///     side than this are located on the side
/// \return the first discontinuity, or nothing if there is none
std::optional<TilingGap> find_gap(const std::vector<Vec3>& vertices,
                                  const std::vector<std::array<std::uint32_t, 3>>& sheet,
                                  const std::vector<std::array<std::uint32_t, 3>>& mesh, const Polygon& outline,
                                  double tolerance_mm);

}  // namespace retrace::geometry
