#pragma once

// Checks that a triangle mesh bounds a solid, by CGAL with exact predicates: for meshes that users bring, and for what
// retrace builds itself.

#include <optional>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// What CGAL finds of a boundary mesh.
struct BoundaryReport {
  bool is_closed = false;    ///< every edge is passed as often in one direction as in the other
  bool is_manifold = false;  ///< if false, the members below keep their default values
  bool self_intersects = true;
  std::optional<Vec3> crossing_mm;  ///< point near one of the self-intersections
  bool bounds_a_volume = false;     ///< true if closed, free of self-intersections and oriented outward
  double volume_mm3 = 0.0;

  bool ok() const { return is_manifold && is_closed && !self_intersects && bounds_a_volume; }
};

/// Checks that a boundary is closed, manifold, outward oriented and does not cross itself (CGAL, exact predicates).
BoundaryReport check_boundary(const BoundaryMesh& mesh);

}  // namespace retrace::geometry
