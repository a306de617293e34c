#pragma once

// Builds the mould of a part as a closed triangle mesh: a block whose upper face is the part's back surface.

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// Returns the closed boundary of the mould of a finite part. The mould is a block below the part's outline. Its upper
/// face is the part's back surface with reversed orientation. The block extends `block_mm` below the deepest point.
/// Coordinates are in the part frame. The volume of the mould is outline area x (element depth + block_mm) minus the
/// volume of the part below z = 0.
/// \pre block_mm > 0; the part is finite and has a single patch
/// \throw std::logic_error if the precondition is not met
BoundaryMesh mould_boundary(const Part& part, double block_mm);

}  // namespace retrace::geometry
