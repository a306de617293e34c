#pragma once

// Maps points of the unit square to points that are uniformly distributed over a set of triangles.

#include <array>
#include <vector>

#include "geometry/vec.h"

namespace retrace::raytrace {

/// Distributes points of the unit square uniformly over triangles that do not overlap.
class TriangleSampler {
 public:
  using Triangle = std::array<geometry::Vec2, 3>;

  TriangleSampler() = default;
  /// \param triangles triangles with counter-clockwise corners; at least one has an area above 0
  /// \param area_mm2 sum of the areas of all triangles
  TriangleSampler(std::vector<Triangle> triangles, double area_mm2);

  /// Maps the unit square onto the triangles and preserves ratios of areas.
  geometry::Vec2 operator()(const std::array<double, 2>& u) const;

 private:
  std::vector<Triangle> triangles_;
  std::vector<double> cumulative_fraction_;  ///< cumulative fraction of the area of the triangles
};

}  // namespace retrace::raytrace
