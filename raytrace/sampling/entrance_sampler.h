#pragma once

// Maps points of the unit square to entry points spread evenly over the entrance face.

#include <array>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::raytrace {

/// Spreads points of the unit square evenly over the entrance face (over one period of an infinite part), relative to
/// the face's centre.
class EntranceSampler {
 public:
  explicit EntranceSampler(const geometry::Part& part);

  /// The point of the part's plane that is the origin of the samples.
  const Vec2& centre_mm() const { return centre_mm_; }

  /// Round the face, relative to its centre; of arrays it is the face.
  geometry::Rectangle bounding_box() const { return {lower_, lower_ + size_}; }

  /// Maps the unit square onto the face, preserving area ratios.
  Vec2 operator()(const std::array<double, 2>& u) const;

 private:
  Vec2 centre_mm_ = Vec2::Zero();
  bool is_rectangle_ = false;
  Vec2 lower_ = Vec2::Zero();
  Vec2 size_ = Vec2::Zero();
  geometry::Polygon outline_;             ///< fan of triangles from the first corner
  std::vector<double> cumulative_share_;  ///< of each triangle of the fan
};

}  // namespace retrace::raytrace
