#pragma once

// Reads faces of STEP files. A separate program, which is started for each file, uses OpenCASCADE to read the file and
// to approximate the faces. Its memory and time are limited, so a damaged file cannot affect this program.

#include <memory>
#include <vector>

#include "geometry/outline/outline.h"
#include "geometry/surface/step_face.h"
#include "geometry/surface/step_surface.h"

namespace retrace::geometry {

/// Maximum deviation of the patches from the surfaces of the file.
inline constexpr double kMaxStepDeviationMm = 1e-6;
inline constexpr double kMaxStepDeviationArcsec = 0.1;

/// Returns the selected faces as a surface z(x, y). Results are kept, and a file that has not changed is not read
/// again.
/// \throw InputError that names the file, if it cannot be read, has no such face, or the faces are not a surface
///     z(x, y)
std::shared_ptr<const StepSurface> read_step_surface(const StepChoice& choice);

/// Returns the borders of the selected faces, projected along z: closed loops in mm, in the rotated frame of the file.
/// Curves other than lines and horizontal circles are approximated by arcs within 1e-5 mm.
/// \throw InputError like read_step_surface()
std::vector<OutlineLoop> read_step_outline(const StepChoice& choice);

}  // namespace retrace::geometry
