#pragma once

// Entrance surfaces of designs that are described by keys.

#include <memory>

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"

namespace retrace::design {

/// Returns the surface that keys of a design describe.
/// \param origin_mm position of its origin
std::shared_ptr<const geometry::EntranceSurface> surface_of(const EntranceForm& form, const geometry::Vec3& origin_mm);

/// Completes a design whose elements are placed below its entrance surface (geometry::OffsetSubstrate): sets the
/// heights of the surface and the thickness of the part, and checks the substrate. Other designs are not changed.
/// \throw InputError that names file, line and key, if the surface folds, or if the substrate is too steep or too
/// curved \pre if the substrate is an OffsetSubstrate, the entrance surface is described by keys
void find_offset(Design& design);

}  // namespace retrace::design
