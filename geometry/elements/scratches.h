#pragma once

// Cuts V-shaped grooves and ridges, as a chipped tool leaves them, into the facets of prisms.

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

/// The prism with its scratches: each facet, and each strip of its edges, is cut into flanks and what is left between
/// them. Heights change along the roof edge alone, so that a root or rim whose sides differ is closed by walls.
/// \pre the cell is a prism's, or there are no scratches
Cell with_scratches(const Cell& cell, const PartSpec& spec);

}  // namespace retrace::geometry
