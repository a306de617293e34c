#pragma once

// The shells of a design (separate lenses in front of the part), prepared for tracing.

#include <optional>
#include <vector>

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "materials/io/material_library.h"
#include "raytrace/light/shells.h"

namespace retrace::design {

/// Returns the shells of a design at one wavelength.
/// \throw InputError for an unknown material, and for a wavelength without index or absorption data
raytrace::Shells shells_at(const Design& design, const materials::MaterialLibrary& library, double wavelength_nm);

/// Returns the material of a shell.
/// \param index index of the shell in Design::shells
/// \throw InputError if the library does not contain the material
const materials::Material& material_of_shell(const Design& design, const materials::MaterialLibrary& library,
                                             std::size_t index);

/// Thickness of a shell and gap behind it, measured along z over the outline of the part.
struct ShellClearance {
  double min_thickness_mm = 0.0;  ///< minimum distance between both surfaces of the shell
  double max_thickness_mm = 0.0;
  double min_gap_mm = 0.0;  ///< minimum distance from the inner surface to the next surface towards the part
};

/// Checks the distances between the surfaces of shells and part, and returns them for each shell.
/// \param entrance curved entrance face; empty if the entrance face is plane
/// \throw InputError at a key of a shell, if its surfaces do not extend over the outline of the part, if they cross
///     each other, or if the shell extends into the next shell or the part
std::vector<ShellClearance> clearances_of_shells(const Design& design, const raytrace::Shells& shells,
                                                 const geometry::Part& part,
                                                 const std::optional<geometry::Entrance>& entrance);

}  // namespace retrace::design
