#pragma once

// A fast special case of the turning path: spirals over polynomial surfaces.

#include <optional>

#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// The spiral of a surface that is a polynomial everywhere, the quick way: by angles, without skew and rake, every turn
/// has the same radial lines, on which the surface is a polynomial of one variable. Nothing if it is not of that kind,
/// or so hollow that the nose may touch in two places.
std::optional<Pass> polynomial_spiral(const geometry::FreeformSurface& surface, const TurningTool& tool,
                                      const PathOptions& options);

}  // namespace retrace::fabrication::turning
