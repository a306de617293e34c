#pragma once

// Groups of directions of incidence for which light is traced only one time: equal directions, and directions that a
// symmetry of the part maps to each other.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace retrace::studies {

/// Direction of incidence in a group of directions that share one trace. Only the first direction of the group is
/// traced. The results of the others are computed from its light.
struct SharedDirection {
  std::size_t index = 0;
  /// Symmetry of the part that maps directions of view to those of the traced light. Components along z do not change.
  Eigen::Matrix2d to_traced = Eigen::Matrix2d::Identity();

  geometry::Vec3 mapped(const geometry::Vec3& direction) const {
    const geometry::Vec2 in_plane = to_traced * direction.head<2>();
    return {in_plane.x(), in_plane.y(), direction.z()};
  }
};

/// Group of directions that share one trace. The first direction is the one that is traced; its map is the identity.
using EquivalentDirections = std::vector<SharedDirection>;

/// Returns the identity, the reflections of x and y that are allowed, and their product.
std::vector<Eigen::Matrix2d> reflections_of(const std::array<bool, 2>& mirrors);

/// Groups directions to the source that can share one trace. The order of the directions is kept.
/// \param symmetries maps that change neither the part nor the polarisation of the light; the first is the identity
std::vector<EquivalentDirections> group_equivalent_directions(const std::vector<geometry::Vec3>& to_source,
                                                              const std::vector<Eigen::Matrix2d>& symmetries);

}  // namespace retrace::studies
