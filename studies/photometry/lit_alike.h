#pragma once

// Directions of incidence that share their light: one that is asked several times, and mirror images at a part that is
// its own mirror image. It is followed once for all of them.

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// One of several directions that share their light. In the light that is followed it looks at what lies where its own
/// directions do with these signs of x and y.
struct SharedDirection {
  std::size_t index = 0;
  geometry::Vec2 signs = geometry::Vec2::Ones();

  geometry::Vec3 mirrored(const geometry::Vec3& direction) const {
    return {signs.x() * direction.x(), signs.y() * direction.y(), direction.z()};
  }
};

/// The first is that of which light is followed, and has no mirror.
using LitAlike = std::vector<SharedDirection>;

/// Sorts directions to the source by whose light they share, in their order. \param mirrors whether the part is its own
/// mirror image along x and along y, and the light has a polarisation that is
std::vector<LitAlike> lit_alike(const std::vector<geometry::Vec3>& to_source, const std::array<bool, 2>& mirrors);

}  // namespace retrace::studies
