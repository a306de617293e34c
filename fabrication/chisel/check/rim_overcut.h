#pragma once

// How deep neighbouring cuts go under a rim where elements on a substrate stand at different heights.

#include <vector>

#include "fabrication/chisel/check/groove.h"

namespace retrace::fabrication {

/// How deep cuts of neighbours go under an element's rims at most, where they stand at different heights or lean
/// towards each other: a facet that is cut up to its own rim is cut on through what stands over it, and the wall of the
/// design between the two rims cannot be (docs/theory/cutting.md). Of the designs alone; 0 where all rims meet.
double rim_overcut_mm(const std::vector<Groove>& grooves);

}  // namespace retrace::fabrication
