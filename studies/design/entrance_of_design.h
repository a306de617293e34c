#pragma once

// The curved entrance surface that a design names, read from its file and put over the part.

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The curved front of a design, read from its file, in the frame of the part: the heights of the file count from
/// z = thickness_mm, its origin lies over EntranceFile::centre_mm. It covers the part, within what the file says is
/// turned, and lies above the highest place of the part's back. \throw InputError naming file and line \pre
/// design.entrance
geometry::Entrance entrance_of_design(const Design& design, const geometry::Part& part);

}  // namespace retrace::studies
