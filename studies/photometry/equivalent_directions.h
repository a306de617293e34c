#pragma once

// Groups of directions of incidence for which light is traced only one time: equal directions, and mirror images of a
// direction if the part is mirror-symmetric.

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// Direction of incidence in a group of directions that share one trace. It uses the traced light of the group's first
/// direction. Multiplying x and y by `signs` transforms directions of view into those of the traced light.
struct SharedDirection {
  std::size_t index = 0;
  geometry::Vec2 signs = geometry::Vec2::Ones();

  geometry::Vec3 mirrored(const geometry::Vec3& direction) const {
    return {signs.x() * direction.x(), signs.y() * direction.y(), direction.z()};
  }
};

/// Group of directions that share one trace. The first direction is the one that is traced; its signs are 1.
using EquivalentDirections = std::vector<SharedDirection>;

/// Groups directions to the source that can share one trace. The order of the directions is kept.
/// \param mirrors for x and y: true if the part and the polarisation of the light are mirror-symmetric along this axis
std::vector<EquivalentDirections> group_equivalent_directions(const std::vector<geometry::Vec3>& to_source,
                                                              const std::array<bool, 2>& mirrors);

}  // namespace retrace::studies
