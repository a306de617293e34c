#pragma once

// The three-dimensional picture of a design as PNG.

#include <string>

#include "studies/drawing/design_view.h"

namespace retrace::report {

/// The part in three dimensions as a PNG file: its back with the elements, as seen from below. \throw
/// OutputError if it cannot be drawn
std::string view_png(const studies::DesignView& view);

}  // namespace retrace::report
