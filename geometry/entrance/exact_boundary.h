#pragma once

// Builds the boundary of a part with a curved entrance face for CAD formats: the entrance face is one exact surface.

#include <optional>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/exact_solid.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Maximum number of points along one side of the bicubic patch of an entrance face.
inline constexpr std::size_t kMaxPatchPoints = 769;

/// Boundary of a part with an exact entrance face.
struct ExactBoundary {
  ExactSolid solid;
  /// Maximum distance along z between the written surface and the entrance surface at points between those that the
  /// patch interpolates. It is 0 for plane, cylinder and sphere.
  double entrance_error_mm = 0.0;
  double volume_mm3 = 0.0;  ///< volume under the entrance surface, by Gaussian quadrature
  double area_mm2 = 0.0;    ///< area of all faces
  double highest_mm = 0.0;  ///< height of the highest point of the entrance surface
};

/// Returns the boundary of a finite part with an exact entrance face. The entrance face is trimmed by the outline of
/// the part. Its edges are shared with the sides.
/// \param surface the entrance surface of the part
/// \param closed_form the same surface in closed form; if it is empty, a bicubic patch approximates the surface
/// \param max_error_mm maximum distance along z between the patch and the surface, > 0
/// \throw InputError if the boundary would touch itself along edges
/// \throw BudgetError if a patch of kMaxPatchPoints points per side deviates more
ExactBoundary exact_boundary(const Part& part, const EntranceSurface& surface,
                             const std::optional<FaceSurface>& closed_form, double max_error_mm);

}  // namespace retrace::geometry
