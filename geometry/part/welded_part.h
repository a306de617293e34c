#pragma once

// Builds parts whose back surface is a single patch, for exports and closed boundaries.

#include "geometry/part/part.h"

namespace retrace::geometry {

/// Builds a part whose complete back surface is a single patch, for any number of elements, as closed_boundary()
/// requires. The memory is proportional to the number of elements.
/// \pre the part is finite
/// \throw InputError as build_part()
Part build_welded_part(const PartSpec& spec);

}  // namespace retrace::geometry
