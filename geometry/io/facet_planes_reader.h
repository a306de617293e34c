#pragma once

// Reads and writes tables (CSV) with the facet planes of individual elements, which may differ from the planes of the
// nominal element.

#include <cstddef>
#include <string>
#include <string_view>

#include "geometry/elements/facet_planes.h"

namespace retrace::geometry {

/// Maximum size of a table of planes, in bytes.
inline constexpr std::size_t kMaxFacetPlanesBytes = std::size_t{512} << 20;

/// Reads the planes of individual facets from a CSV table with `#` comments and the header
/// `x_mm,y_mm,facet,height_mm,x_slope,y_slope`. There is a line for each facet of an element, with z = height_mm +
/// x_slope (x - x_mm) + y_slope (y - y_mm).
/// The numbers in the column `facet` have the following meanings. For prisms, 1 is the facet towards -x (-y for a
/// rotated element), and 2 is the opposite facet. For cube corners, 1 to 3 are the facets between the dihedral edges,
/// starting from the edge at 0 degrees. Flares have the numbers 4 to 6 and replace a missing hexagonal element
/// (ElementPlanes::flares). Caps have the numbers 7 to 9 and are the surfaces that a chisel leaves over the apex
/// (ElementPlanes::caps). In the file, the lines of the caps must come after the lines of the facets of the same
/// element.
/// \param spec array to which the planes belong; planes may differ from its facets by at most 5 degrees and a tenth of
///        the depth
/// \throw InputError with file, line and column
geometry::FacetPlanes parse_facet_planes(std::string_view text, const std::string& file,
                                         const geometry::PartSpec& spec);

/// Returns the planes as a table in the same format.
std::string facet_planes_text(const geometry::FacetPlanes& planes);

}  // namespace retrace::geometry
