#pragma once

// Whether a part is its own mirror image: light of mirrored directions is mirrored then, too.

#include "geometry/part/part.h"

namespace retrace::raytrace {

/// Whether the part is the same mirrored along an axis (0: x, 1: y), in the middle of a finite part, anywhere of one
/// that repeats without end.
bool is_its_own_mirror_image(const geometry::Part& part, Eigen::Index axis);

}  // namespace retrace::raytrace
