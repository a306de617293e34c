#pragma once

// Builds parts whose back surface is a single patch, for exports and closed boundaries.

#include "geometry/part/part.h"

namespace retrace::geometry {

/// Builds a part with any number of elements whose complete back surface is a single patch. closed_boundary() requires
/// such a part. The memory is proportional to the number of elements.
/// \pre the part is finite
/// \throw InputError in the same cases as build_part()
Part build_welded_part(const PartSpec& spec);

}  // namespace retrace::geometry
