#pragma once

// Rays that look for a surface, and the facets that they start from and hit.

#include <cstdint>
#include <limits>

#include "geometry/vec.h"

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

/// A facet of the back surface: which placement of which patch, and which facet of that.
struct FacetRef {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t placement = kNone;
  std::uint32_t facet = kNone;

  friend bool operator==(const FacetRef&, const FacetRef&) = default;
};

/// A ray towards the back surface. It never hits the facet it starts from: that one is excluded by name, not by
/// distance.
struct SurfaceRay {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();
  FacetRef source;
  bool inside = true;  ///< in the part's material
  double t_max = std::numeric_limits<double>::infinity();
};

struct SurfaceHit {
  FacetRef facet;
  double t = std::numeric_limits<double>::infinity();
};

}  // namespace retrace::raytrace
