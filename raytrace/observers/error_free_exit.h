#pragma once

// Computes the point and the phase with which a returned beam would leave the part if its facets had no errors of
// angle.

#include <Eigen/Geometry>
#include <optional>

#include "geometry/vec.h"
#include "raytrace/exact/beam_tracer.h"

namespace retrace::raytrace {

/// Changes of the position and phase of a beam on the entrance face if errors of angle are removed. These errors
/// deflect the beam, which displaces it on the path from the cell to the entrance face.
///
/// The reflections of a path form an isometry. Without errors of angle, the isometry is an involution, which means that
/// it is its own inverse. For a cube corner, it is the point reflection at the apex. For a prism, it is the rotation by
/// 180 degrees about the roof edge. With errors of angle, the nearest involution is used.
/// All paths of a cell have the same involution. Their exit polygons therefore do not overlap, and the sum of their
/// fields conserves the power (docs/theory/photometry.md, "Diffraction").
struct ErrorFreeExit {
  /// Maps the actual exit point of light to the exit point without errors of angle. Both points are on the entrance
  /// face and relative to the part's centre.
  Eigen::Affine2d from_exit = Eigen::Affine2d::Identity();
  /// Value in mm that must be added to ReturnedBeam::phase_mm when the exit point is moved by `from_exit`. The wave
  /// then keeps its phase at the apex of the element.
  double phase_change_mm = 0.0;
};

/// Combined effect of the reflections of a path: the map x -> matrix x + shift_mm, with an orthogonal matrix. It maps
/// the point and the direction that the light would have without reflections to the actual point and direction.
/// Coordinates are relative to the part's centre, and the entrance face is the plane z = 0.
struct PathIsometry {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Vec3 shift_mm = Vec3::Zero();
};

/// Computes the isometry of a returned beam behind a plane entrance face. Returns nothing if light is refracted at the
/// back surface, or leaves almost parallel to the entrance face.
/// \param to_source unit vector towards the source
std::optional<PathIsometry> path_isometry(const ReturnedBeam& beam, const Vec3& to_source);

/// Computes the exit of a beam without errors of angle.
/// \param to_source unit vector towards the source
/// \param cell_mm position of the cell, relative to the part's centre
/// \return the exit, or nothing if it cannot be computed. This happens if light is refracted at the back surface or
///         leaves almost parallel to the entrance face. It also happens if no involution is close to the isometry of
///         the path, or if the nearest one reverses no axis.
std::optional<ErrorFreeExit> error_free_exit(const ReturnedBeam& beam, const Vec3& to_source,
                                             const geometry::Vec2& cell_mm);

}  // namespace retrace::raytrace
