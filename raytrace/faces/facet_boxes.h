#pragma once

// The boxes round cells and facets that Embree searches.

#include <cstdint>
#include <vector>

#include "geometry/part/surface_patch.h"
#include "raytrace/faces/exact_surface.h"

namespace retrace::raytrace {

/// What a box of the search is put round: facets of a cell, or one of so many pieces of equal length of a single facet.
struct BoxContent {
  ExactSurface::FacetRange range;
  std::uint16_t piece = 0;
  std::uint16_t pieces = 1;
};

struct FacetBox {
  Vec3 lower;
  Vec3 upper;
};

/// A box for every cell of few facets; boxes for every facet of others, more than one if it is long and runs aslant.
std::vector<BoxContent> box_contents(const geometry::SurfacePatch& patch);

/// In the patch's coordinates.
FacetBox box_round(const geometry::SurfacePatch& patch, const BoxContent& content);

}  // namespace retrace::raytrace
