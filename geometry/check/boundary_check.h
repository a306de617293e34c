#pragma once

// Checks that a triangle mesh bounds a solid, by CGAL with exact predicates: for meshes that users bring, and for what
// retrace builds itself.

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// What CGAL finds of a boundary mesh.
struct BoundaryReport {
  bool is_closed = false;    ///< every edge is passed as often in one direction as in the other
  bool is_manifold = false;  ///< no edge belongs to more than two triangles; what follows is found only then
  bool self_intersects = true;
  bool bounds_a_volume = false;  ///< closed, free of self-intersections, normals outward
  double volume_mm3 = 0.0;

  bool ok() const { return is_manifold && is_closed && !self_intersects && bounds_a_volume; }
};

/// Checks that a boundary is closed, manifold, outward oriented and does not cross itself (CGAL, exact predicates).
BoundaryReport check_boundary(const BoundaryMesh& mesh);

}  // namespace retrace::geometry
