#pragma once

// Cuts V-shaped grooves and ridges into the facets of prisms. A chipped tool leaves such scratches.

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

/// Returns the prism with its scratches. Each facet and each strip of its edges is divided into the flanks of scratches
/// and the areas between them. Heights change only along the roof edge. If the two sides of a root or rim differ in
/// height, walls close the difference.
/// \pre the cell is a prism, or there are no scratches
Cell with_scratches(const Cell& cell, const PartSpec& spec);

}  // namespace retrace::geometry
