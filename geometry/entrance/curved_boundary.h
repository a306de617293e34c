#pragma once

// Builds the complete boundary of a part with a curved entrance face as one closed triangle mesh, for export, figures
// and checks.

#include <cstddef>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/closed_boundary.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Closed boundary of a part with a curved entrance face.
struct CurvedBoundary {
  BoundaryMesh mesh;
  /// Maximum distance along z between the triangles of the entrance face and the exact surface, measured at points
  /// within the triangles. It is 0 if the entrance face is a mesh, because the triangles of this mesh are used.
  double entrance_error_mm = 0.0;
};

/// Maximum number of polygons into which curved_boundary() divides an entrance face.
inline constexpr std::size_t kMaxEntrancePolygons = 200'000;

/// Returns the closed boundary of a finite part: back surface, border walls, sides and entrance face. Triangles that
/// touch each other share complete edges. An exact surface is approximated by triangles whose corners are on the
/// surface. The plan is divided into square cells, and cells are divided further until their triangles are accurate
/// enough.
/// \param max_error_mm maximum distance along z between the triangles and an exact surface; > 0
/// \pre the back surface is a single patch, and the entrance face covers the part
/// \throw BudgetError if an exact surface needs more than kMaxEntrancePolygons polygons
/// \throw InputError if the entrance face touches the back at the border of the part
/// \throw std::logic_error if the part is infinite or has several patches
CurvedBoundary curved_boundary(const Part& part, const Entrance& entrance, double max_error_mm);

}  // namespace retrace::geometry
