#pragma once

// Where light of a returned beam would leave the entrance face if the facets on its path had no errors of angle.

#include <Eigen/Geometry>
#include <optional>

#include "geometry/vec.h"
#include "raytrace/exact/beam_tracer.h"

namespace retrace::raytrace {

/// Exit of a beam with the sideways shift removed that errors of angle cause between the cell and the entrance face.
///
/// The reflections of a path multiply to an isometry. Without errors it is an involution: inversion at the apex of a
/// cube corner, half a turn about the roof edge of a prism. The nearest involution maps the entry polygons of all paths
/// of a cell in the same way, so that they remain disjoint and their fields conserve power (docs/theory/photometry.md,
/// "Diffraction").
struct ErrorFreeExit {
  Eigen::Affine2d from_exit = Eigen::Affine2d::Identity();  ///< of places on the face, relative to the part's centre
  double phase_change_mm = 0.0;  ///< to add to ReturnedBeam::phase_mm: the wave keeps its phase at the apex
};

/// Computes the error-free exit of a beam.
/// \param to_source direction to the source, of length 1
/// \param cell_mm position of the cell, relative to the part's centre
/// \return nothing if the path is not a sequence of reflections, or its isometry is not near an involution
std::optional<ErrorFreeExit> error_free_exit(const ReturnedBeam& beam, const Vec3& to_source,
                                             const geometry::Vec2& cell_mm);

}  // namespace retrace::raytrace
