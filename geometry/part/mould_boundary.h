#pragma once

// Builds the mould of a part as a closed triangle mesh: a block whose upper face is the part's back surface.

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// The closed boundary of the mould of a finite part: the block under the part's outline whose upper face is the part's
/// back surface, seen from the other side. It reaches `block_mm` below the deepest point; the frame is the part's.
/// Its volume is outline area x (element depth + block_mm) less what of the part lies below z = 0.
/// \pre block_mm > 0, the part is finite and one patch
/// \throw std::logic_error otherwise
BoundaryMesh mould_boundary(const Part& part, double block_mm);

}  // namespace retrace::geometry
