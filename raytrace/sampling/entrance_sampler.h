#pragma once

// Maps points of the unit square to entry points that are uniformly distributed over the entrance face.

#include <array>

#include "geometry/part/part.h"
#include "raytrace/sampling/triangle_sampler.h"

namespace retrace::raytrace {

using geometry::Vec2;

/// Distributes points of the unit square uniformly over the entrance face, or over one period of an infinite part. The
/// results are relative to the centre of the face.
class EntranceSampler {
 public:
  explicit EntranceSampler(const geometry::Part& part);

  /// Returns the centre of the face, which is the origin of the results, in the part frame.
  const Vec2& centre_mm() const { return centre_mm_; }

  /// Returns the bounding box of the face, relative to its centre. For arrays, it is the face itself.
  geometry::Rectangle bounding_box() const { return {lower_, lower_ + size_}; }

  /// Maps the unit square onto the face and preserves ratios of areas.
  Vec2 operator()(const std::array<double, 2>& u) const;

 private:
  Vec2 centre_mm_ = Vec2::Zero();
  bool is_rectangle_ = false;
  Vec2 lower_ = Vec2::Zero();
  Vec2 size_ = Vec2::Zero();
  TriangleSampler triangles_;  ///< triangles that make up the face; not used for rectangles
};

}  // namespace retrace::raytrace
