#pragma once

// Symmetries of a part about its normal. If a part is symmetric, symmetric directions of incidence give symmetric
// results, so that only one of them has to be traced.

#include <Eigen/Core>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Returns true if a part is symmetric about a plane normal to an axis (0: x, 1: y). For a finite part, the plane
/// passes through its centre. For an infinite part, it may have any position, and the part may be shifted along it.
bool is_mirror_symmetric(const geometry::Part& part, Eigen::Index axis);

/// Returns the orthogonal maps of directions in the plane z = 0 that do not change a part: its rotations about the z
/// axis by multiples of 60 or 90 degrees, its reflections across the x and y axes, and their products. The first is the
/// identity. For an infinite part, maps that leave it unchanged except for a shift also count.
std::vector<Eigen::Matrix2d> symmetries_of(const geometry::Part& part);

}  // namespace retrace::raytrace
