#pragma once

// Determines where one plane is above another over a polygon, and hence which facet of a cell forms the surface.

#include "geometry/elements/element_cells.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// Returns the portion of a convex polygon in which one plane is at least as high as another. It is empty if it has no
/// area.
Polygon where_higher(const Polygon& polygon, const HeightPlane& plane, const HeightPlane& other);

/// Returns the planes over an outline, each with the outline in which it is the highest. If a plane is nowhere the
/// highest, its outline is empty.
std::vector<CellFacet> upper_envelope_of(const Polygon& outline, std::vector<CellFacet> planes);

}  // namespace retrace::geometry
