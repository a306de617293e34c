#pragma once

// Light that a curved entrance surface reflects at its outer side: the mirror image of the source, which the curvature
// spreads over many directions.

#include <functional>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/polygon.h"
#include "raytrace/light/aperture_kernel.h"

namespace retrace::raytrace {

/// Returns the power per steradian that a surface reflects towards a receiver, as a fraction of the incident power. The
/// value is averaged over the discs of source and receiver, and computed by geometrical optics. Reflected light that
/// would meet the surface again is counted as if nothing were in its way.
/// \param outline convex outline of the part
/// \param beam_plane plane that touches the surface from above. The incident beam covers the outline in this plane.
/// \param reflectance function that returns the reflected fraction of the power for a unit normal of the surface (part
///     frame)
double reflected_per_sr(const geometry::EntranceSurface& surface, const geometry::Polygon& outline,
                        const geometry::TouchingPlane& beam_plane, const geometry::Vec3& to_source,
                        const geometry::Vec3& receiver, const ApertureKernel& kernel,
                        const std::function<double(const geometry::Vec3& normal)>& reflectance);

/// Calls visit(direction, power) for points of the surface on a grid. The sum of all powers is the power that the
/// surface reflects, as a fraction of the incident light. The other parameters are those of reflected_per_sr().
/// \param columns number of points along each side of the outline's bounding box
void visit_reflected(const geometry::EntranceSurface& surface, const geometry::Polygon& outline,
                     const geometry::TouchingPlane& beam_plane, const geometry::Vec3& to_source, std::size_t columns,
                     const std::function<double(const geometry::Vec3& normal)>& reflectance,
                     const std::function<void(const geometry::Vec3& direction, double power)>& visit);

}  // namespace retrace::raytrace
