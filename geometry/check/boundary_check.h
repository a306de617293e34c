#pragma once

// Checks that a triangle mesh bounds a solid. CGAL with exact predicates is used. The check is applied to meshes from
// users' files and to meshes that retrace builds.

#include <optional>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// Result of check_boundary().
struct BoundaryReport {
  bool is_closed = false;    ///< every edge is traversed equally often in both directions
  bool is_manifold = false;  ///< if false, the members below keep their default values
  bool self_intersects = true;
  std::optional<Vec3> crossing_mm;  ///< point near one of the self-intersections
  bool bounds_a_volume = false;     ///< true if closed, free of self-intersections and oriented outward
  double volume_mm3 = 0.0;

  bool ok() const { return is_manifold && is_closed && !self_intersects && bounds_a_volume; }
};

/// Checks that a mesh is closed, manifold and oriented outward, and that it does not intersect itself.
BoundaryReport check_boundary(const BoundaryMesh& mesh);

}  // namespace retrace::geometry
