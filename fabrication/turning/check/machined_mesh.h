#pragma once

// Converts the turned surface with its cusps to a mesh of the moulded part, which can be traced.

#include "fabrication/turning/check/inspection.h"
#include "geometry/part/closed_boundary.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Returns a closed mesh of the part that is moulded in the turned surface, with outward normals. The back of the part
/// is the machined surface, at the intersections of circles and rays about the spindle's axis. The entrance face is a
/// horizontal plane above it. Within 4 feeds of the centre, the height of the design is used, because the edge hardly
/// moves over the part there.
/// \param rings number of circles, at least 2; the largest one is 4 feeds inside of the rim
/// \param thickness_mm distance from the highest point of the back to the entrance face; > 0
/// \pre the region is round
/// \throw InputError if the programs leave one of the points uncut
geometry::BoundaryMesh machined_mesh(const Envelope& envelope, const geometry::FreeformSurface& design,
                                     const InspectedRegion& region, int rings, double thickness_mm);

}  // namespace retrace::fabrication::turning
