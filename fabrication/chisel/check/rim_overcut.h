#pragma once

// Computes how deep the cuts of neighbouring elements go below the rims of an element if the rims have different
// heights.

#include <vector>

#include "fabrication/chisel/check/cavity.h"

namespace retrace::fabrication {

/// Returns the maximum depth by which the cuts of neighbouring elements go below the rims of an element. This happens
/// between elements at different heights or with different inclinations. The cut of a facet continues beyond its own
/// rim and removes material of a higher neighbour. The designed wall between the rims can therefore not be made
/// (docs/theory/cutting.md). The result depends only on the design. It is 0 if all rims meet. Neighbours in other zones
/// are not included (see zone_overcut.h).
double rim_overcut_mm(const std::vector<Cavity>& grooves);

}  // namespace retrace::fabrication
