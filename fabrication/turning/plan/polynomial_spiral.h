#pragma once

// Fast special case of the turning path: spirals over polynomial surfaces.

#include <optional>

#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// Computes the spiral of a polynomial surface. With points at equal angles, and without skew and rake, the points of
/// all turns are on the same radial lines. On each line, the surface is a polynomial of one variable, which makes the
/// computation fast. Returns nothing if the surface or the options do not have this form, or if the nose may have two
/// points of contact.
std::optional<Pass> polynomial_spiral(const geometry::FreeformSurface& surface, const TurningTool& tool,
                                      const PathOptions& options);

}  // namespace retrace::fabrication::turning
