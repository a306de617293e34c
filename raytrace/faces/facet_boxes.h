#pragma once

// Bounding boxes of cells and facets for Embree.

#include <cstdint>
#include <vector>

#include "geometry/part/surface_patch.h"
#include "raytrace/faces/exact_surface.h"

namespace retrace::raytrace {

/// Content of a bounding box: consecutive facets of a cell, or a part of a single facet that is divided into parts of
/// equal length.
struct BoxContent {
  ExactSurface::FacetRange range;
  std::uint16_t part = 0;   ///< index of the part of the facet
  std::uint16_t parts = 1;  ///< number of parts of the facet
};

struct FacetBox {
  Vec3 lower;
  Vec3 upper;
};

/// Returns the contents of all boxes of a patch. A cell with few facets has one box. In other cells, each facet has one
/// box, and a long oblique facet has several boxes.
std::vector<BoxContent> box_contents(const geometry::SurfacePatch& patch);

/// Returns the bounding box of a content, in the patch's coordinates.
FacetBox bounding_box_of(const geometry::SurfacePatch& patch, const BoxContent& content);

}  // namespace retrace::raytrace
