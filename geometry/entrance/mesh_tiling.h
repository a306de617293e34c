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

/// Fault at a position at which the triangles are not continuous.
enum class TilingFault {
  hole,
  overlap,
  height_jump,
  corner_on_side,    ///< a corner is located on the side of another triangle
  no_area,           ///< a triangle has no area
  upright_triangle,  ///< a triangle is vertical
  overhang,          ///< a triangle faces -z and continues the sheet
  reversed_triangle  ///< the corners of a triangle have the wrong order
};

/// Returns the fault as a clause for messages, such as "there is a hole".
std::string_view text_of(TilingFault fault);

/// Position at which the triangles are not continuous.
struct TilingGap {
  TilingFault fault = TilingFault::hole;
  Vec2 at_mm = Vec2::Zero();
};

/// Checks that triangles which all face +z are continuous across each of their sides within a convex outline.
///
/// The check has two steps. First, each side must be traversed equally often in both directions. The number of
/// triangles above a point is then constant inside the outline. Second, the areas of the triangles over the outline
/// must add up to the area of the outline. The number is then one, and the triangles tile the outline. Corners are
/// shared in three dimensions, so heights are continuous.
/// \param sheet triangles to check
/// \param mesh all triangles of the mesh, which determine the fault at a gap
/// \param tolerance_mm maximum distance at which a side counts as part of the outline, or a corner counts as a point on
///     a side
/// \return the first gap, or nothing
std::optional<TilingGap> find_gap(const std::vector<Vec3>& vertices,
                                  const std::vector<std::array<std::uint32_t, 3>>& sheet,
                                  const std::vector<std::array<std::uint32_t, 3>>& mesh, const Polygon& outline,
                                  double tolerance_mm);

}  // namespace retrace::geometry
