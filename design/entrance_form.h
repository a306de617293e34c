#pragma once

// Entrance surfaces that are described by keys of a design, and substrates below them.

#include <memory>
#include <optional>

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/exact_solid.h"

namespace retrace::design {

/// Returns the entrance surface that keys of a design describe.
/// \param origin_mm position of the surface's origin in the part frame
std::shared_ptr<const geometry::EntranceSurface> surface_of(const EntranceForm& form, const geometry::Vec3& origin_mm);

/// Returns the entrance surface that keys of a design describe, in closed form. Returns nothing unless it is a plane, a
/// circular cylinder or a sphere of at most 100 m radius. Rounding errors of larger radii would exceed the tolerances
/// of CAD programs. \param origin_mm as in surface_of()
std::optional<geometry::FaceSurface> closed_form_of(const EntranceForm& form, const geometry::Vec3& origin_mm);

/// Completes a design whose elements are placed below its entrance surface (geometry::OffsetSubstrate). Sets the
/// heights of the surface and the thickness of the part, and checks the substrate. Does not change other designs.
/// \pre if the substrate is an OffsetSubstrate, the entrance surface is described by keys
/// \throw InputError that names file, line and key, if the surface folds or the substrate is too steep or curved
void find_offset(Design& design);

}  // namespace retrace::design
