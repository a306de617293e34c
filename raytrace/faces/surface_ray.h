#pragma once

// Rays for the search for intersections with a surface, and references to the facets where the rays start and end.

#include <cstdint>
#include <limits>

#include "geometry/vec.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// Reference to a facet of the back surface: the index of a placement of a patch, and the index of the facet in the
/// patch.
struct FacetRef {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t placement = kNone;
  std::uint32_t facet = kNone;

  friend bool operator==(const FacetRef&, const FacetRef&) = default;
};

/// A ray towards the back surface. It never hits the facet from which it starts. This facet is excluded by its index
/// and not by distance.
struct SurfaceRay {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();
  FacetRef source;
  bool inside = true;  ///< true if the ray is in the material of the part
  double t_max = std::numeric_limits<double>::infinity();
};

struct SurfaceHit {
  FacetRef facet;
  double t = std::numeric_limits<double>::infinity();
};

}  // namespace retrace::raytrace
