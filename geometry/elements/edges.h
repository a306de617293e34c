#pragma once

// Rounds and chamfers the roots and rims of elements, as strips of plane facets.

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

/// The element with its edges rounded or chamfered. A rim is rounded as if the neighbour were the element's mirror
/// image, or against level land where a gap keeps neighbours apart. Edges below 1e-7 of the element's size stay sharp.
/// \pre the arcs fit into the facets
Cell with_edges(const Cell& cell, const PartSpec& spec);

/// Rectangular land at z = 0 between prisms, with what rounded rims take of it. `lower` and `upper` say whether a rim
/// runs along its lower and upper side on `axis` (0: x, 1: y). \pre the arcs fit into the land
Cell land_cell(const Rectangle& rectangle, const PartSpec& spec, Eigen::Index axis = 0, bool lower = false,
               bool upper = false);

/// How far a rounded rim reaches over the land beside a prism; 0 where rims are sharp.
double rim_reach_over_land_mm(const PartSpec& spec);

/// Share of an element's plan that its edges and scratches take.
double edge_share(const Cell& cell);

}  // namespace retrace::geometry
