#pragma once

// Smallest distance between the entrance face and the back of a part.

#include <optional>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::studies {

/// Smallest wall of a part, and the two points between which it is measured.
struct WallThickness {
  double thickness_mm = 0.0;
  geometry::Vec3 back_mm = geometry::Vec3::Zero();      ///< point on the back
  geometry::Vec3 entrance_mm = geometry::Vec3::Zero();  ///< point on the entrance face
};

/// Returns the smallest distance between the entrance face of a part and the facets of its back.
/// \param entrance curved entrance face, or nothing for a plane
/// \pre the part has at least one facet that is not a side
WallThickness smallest_wall(const geometry::Part& part, const std::optional<geometry::Entrance>& entrance);

}  // namespace retrace::studies
