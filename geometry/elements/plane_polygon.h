#pragma once

// Where one plane lies above another over a polygon: what decides which facet of a cell is seen.

#include "geometry/elements/element_cells.h"
#include "geometry/polygon.h"

namespace retrace::geometry {

/// The part of a convex polygon where one plane is at least as high as another; empty if it has no area.
Polygon where_higher(const Polygon& polygon, const HeightPlane& plane, const HeightPlane& other);

/// Of several planes over an outline each where it is the highest; those that are nowhere have an empty outline.
std::vector<CellFacet> highest_of(const Polygon& outline, std::vector<CellFacet> planes);

}  // namespace retrace::geometry
