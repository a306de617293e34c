#pragma once

#include <vector>

#include "core/schema/document.h"
#include "fabrication/turning/surface.h"

namespace retrace::fabrication::turning {

/// The table [lenslets] of a part file: positions, the sag that all have (its formula may go by their place), and
/// their boundaries. \throw InputError with file, line and key
std::vector<Lenslet> read_lenslets(const schema::Document& file, const TurnedSurface& base);

}  // namespace retrace::fabrication::turning
