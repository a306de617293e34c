#pragma once

// Test for mirror symmetry of a part. If a part is symmetric, mirrored directions of incidence give mirrored results.

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Returns true if a part is symmetric about a plane normal to an axis (0: x, 1: y). For a finite part, the plane
/// passes through its centre. For an infinite part, it may have any position.
bool is_mirror_symmetric(const geometry::Part& part, Eigen::Index axis);

}  // namespace retrace::raytrace
