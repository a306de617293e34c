#pragma once

// Converts the turned surface with its cusps to a mesh of the moulded part, which can be traced.

#include "fabrication/turning/check/inspection.h"
#include "geometry/part/closed_boundary.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// What is moulded in the turned surface: its back is what the programs leave, at the crossings of circles and rays
/// about the spindle's axis, its entrance face a level plane above. The design's height stands for the places within 4
/// feeds of the centre, where the edge turns on the spot. A closed mesh that looks outward.
/// \param rings circles, 2 or more, out to 4 feeds inside of the rim \param thickness_mm from the highest place of the
/// back to the entrance face; > 0 \pre a round region \throw InputError if the programs leave one of the places uncut
geometry::BoundaryMesh machined_mesh(const Envelope& envelope, const geometry::FreeformSurface& design,
                                     const InspectedRegion& region, int rings, double thickness_mm);

}  // namespace retrace::fabrication::turning
