#pragma once

// Parts whose back surface is one patch, as exports and closed boundaries need it.

#include "geometry/part/part.h"

namespace retrace::geometry {

/// The part with its whole back surface as one patch, however many elements it has, as closed_boundary() takes it.
/// Memory grows with the number of elements. \pre the part is finite
/// \throw InputError as build_part() does
Part build_welded_part(const PartSpec& spec);

}  // namespace retrace::geometry
