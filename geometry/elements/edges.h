#pragma once

// Rounds and chamfers the roots and rims of elements. At a root, facets of one element meet; at a rim, an element meets
// its neighbour or flat land. The rounded or chamfered edges consist of strips of plane facets.

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {

/// Returns the element with rounded or chamfered edges. A rim is rounded as if the neighbour were the element's mirror
/// image. If a gap separates the neighbours, the rim is rounded towards horizontal land. Edges smaller than 1e-7 of the
/// element's size stay sharp.
/// \pre the arcs fit into the facets
Cell with_edges(const Cell& cell, const PartSpec& spec);

/// Returns rectangular land at z = 0 between prisms, without the strips that rounded rims occupy.
/// \param axis axis across the rims (0: x, 1: y)
/// \param lower true if a rim is on the lower side along `axis`
/// \param upper true if a rim is on the upper side along `axis`
/// \pre the arcs fit into the land
Cell land_cell(const Rectangle& rectangle, const PartSpec& spec, Eigen::Index axis = 0, bool lower = false,
               bool upper = false);

/// Returns the distance by which a rounded rim extends over the land next to a prism. Returns 0 if rims are sharp.
double rim_reach_over_land_mm(const PartSpec& spec);

/// Returns the fraction of an element's area in plan that its edges and scratches occupy.
double edge_fraction(const Cell& cell);

}  // namespace retrace::geometry
