#pragma once

// Determines which facets of a mesh form one element, such as the three facets of a cube corner.

#include <cstdint>
#include <vector>

#include "geometry/elements/element_cells.h"
#include "geometry/part/region_polygons.h"

namespace retrace::geometry {

/// Returns the element number of each plane region, counted from 0. Regions belong to one element if they meet at an
/// edge where the solid is convex, such as the dihedral edges of a cube corner. Edges where the solid is concave are
/// rims between elements. There is one exception: if the normals at a concave edge differ by less than one degree, both
/// regions are parts of one curved facet.
/// A wall belongs to the element with which it shares its longest convex edge. A wall does not connect two elements.
/// \param roles role of each region
/// \param rounding_mm maximum error of a vertex, mm; edges shorter than a few times this error are ignored
std::vector<std::uint32_t> elements_of_regions(const std::vector<Vec3>& vertices, const RegionTriangles& mesh,
                                               const std::vector<FacetPlane>& planes,
                                               const std::vector<FacetRole>& roles, double rounding_mm);

}  // namespace retrace::geometry
