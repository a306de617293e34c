#pragma once

// Draws a three-dimensional picture of a design as PNG.

#include <string>

#include "studies/drawing/design_view.h"

namespace retrace::report {

/// Returns a PNG file of the part in three dimensions: its back with the elements, seen from below. A part with
/// a curved entrance face is also shown from above.
/// \throw OutputError if the picture cannot be drawn
std::string view_png(const studies::DesignView& view);

}  // namespace retrace::report
