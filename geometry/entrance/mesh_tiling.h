#pragma once

// Tests whether triangles cover a convex outline exactly once, and names the first place where they do not.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// A place where triangles do not go on.
struct TilingGap {
  std::string_view what;  ///< "there is a hole"
  Vec2 at_mm = Vec2::Zero();
};

/// Whether triangles that all look towards +z go on across each of their sides over the inside of a convex outline.
///
/// Where every side is passed as often one way as the other, the number of triangles over a place changes nowhere
/// inside: the border of their sum, taken in plan, is empty there. If their areas over the outline add up to its own
/// as well, that number is one: they tile it. Corners are shared in three dimensions, so that heights do not jump.
/// \param sheet the triangles \param mesh all triangles, which tell what stands in a gap
/// \param tolerance_mm within which a side counts as the outline's, and a corner as one on a side
/// \return the first place where they do not
std::optional<TilingGap> find_gap(const std::vector<Vec3>& vertices,
                                  const std::vector<std::array<std::uint32_t, 3>>& sheet,
                                  const std::vector<std::array<std::uint32_t, 3>>& mesh, const Polygon& outline,
                                  double tolerance_mm);

}  // namespace retrace::geometry
