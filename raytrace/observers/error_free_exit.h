#pragma once

// Computes where a returned beam would leave the entrance face if the facets had no errors of angle.

#include <Eigen/Geometry>
#include <optional>

#include "geometry/vec.h"
#include "raytrace/exact/beam_tracer.h"

namespace retrace::raytrace {

/// Position and phase with which a beam would leave the entrance face without errors of angle. These errors shift the
/// beam sideways on its path from the cell to the face.
///
/// The reflections of a path form an isometry. Without errors of angle, the isometry is an involution, that is, its own
/// inverse. It is the point reflection at the apex of a cube corner or the rotation by 180 degrees about the roof edge
/// of a prism. With errors, the nearest involution is used. All paths of a cell have the same involution. Their exit
/// polygons therefore do not overlap, and their fields conserve power (docs/theory/photometry.md, "Diffraction").
struct ErrorFreeExit {
  /// Maps the true exit point of light to its exit point without errors of angle. Both are points of the entrance face,
  /// relative to the part's centre.
  Eigen::Affine2d from_exit = Eigen::Affine2d::Identity();
  /// Correction, in mm, that the caller adds to ReturnedBeam::phase_mm after it moves the exit point by `from_exit`.
  /// The wave then has the same phase at the apex of the element as before the move.
  double phase_change_mm = 0.0;
};

/// Returns the exit that a beam would have without errors of angle.
/// \param to_source unit vector towards the source
/// \param cell_mm position of the cell, relative to the part's centre
/// \return the exit. None if light is refracted at the back surface, if it leaves almost parallel to the entrance face,
///         or if no involution that reverses an axis is near the isometry of the path.
std::optional<ErrorFreeExit> error_free_exit(const ReturnedBeam& beam, const Vec3& to_source,
                                             const geometry::Vec2& cell_mm);

}  // namespace retrace::raytrace
