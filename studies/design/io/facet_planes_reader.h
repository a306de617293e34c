#pragma once

// Reads and writes tables of facet planes (CSV), by which single elements of an array differ from the nominal one.

#include <cstddef>
#include <string>
#include <string_view>

#include "geometry/elements/facet_planes.h"

namespace retrace::studies {

/// Longest table of planes that is read.
inline constexpr std::size_t kMostFacetPlanesBytes = std::size_t{512} << 20;

/// Facets of single elements as planes: CSV with `#` comments and the header
/// `x_mm,y_mm,facet,height_mm,x_slope,y_slope`, a line for each facet of an element. Of prisms `facet` 1 looks towards
/// -x (of a turned element -y), 2 the other way; of cube corners 1 to 3 lie between the dihedral edges from that at 0
/// degrees, 4 to 6 are flares in the place of a hexagonal one that is not there, and 7 to 9 what a chisel leaves over
/// the apex, in lines behind those of its facets (ElementPlanes::flares, caps). z = height_mm + x_slope (x - x_mm) +
/// y_slope (y - y_mm). \param spec of the array they belong to, whose facets they must resemble: within 5 degrees and a
/// tenth of the depth \throw InputError with file, line and column
geometry::FacetPlanes parse_facet_planes(std::string_view text, const std::string& file,
                                         const geometry::PartSpec& spec);

/// The same table from planes.
std::string facet_planes_text(const geometry::FacetPlanes& planes);

}  // namespace retrace::studies
