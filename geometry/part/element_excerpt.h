#pragma once

// Finds the elements of a part, and cuts out one element with its surroundings as a separate part in a rotated frame.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::geometry {

/// One element of a finite part: a placement of a patch and the cells of the element in this patch.
struct PartElement {
  std::uint32_t placement = 0;
  std::vector<std::uint32_t> cells;  ///< indices into SurfacePatch::cells
  /// Point where the largest number of retro facets meet, in the part frame. This is the apex of a cube corner or the
  /// middle of the roof edge of a prism. If several points have the largest number, it is their mean.
  Vec3 apex_mm = Vec3::Zero();
  Vec3 lower_mm = Vec3::Zero();  ///< bounding box in the part frame
  Vec3 upper_mm = Vec3::Zero();
  std::vector<Vec3> corners_mm;  ///< all corners of the element's facets, in the part frame
};

/// Returns all elements of a finite part, whole and cut. An element has at least one retro facet.
std::vector<PartElement> part_elements(const Part& part);

/// Origin of a cell in an excerpt: the selected element, another element, flat land between elements, or a side of the
/// original part.
enum class ExcerptCell { own_element, other_element, land, side };

/// Element with its surroundings as a separate part. Coordinates are in the frame of the excerpt.
struct ElementExcerpt {
  /// Facets of the element and of its surroundings. The entrance face is the plane z = `thickness_mm`. The original
  /// part continues beyond `outline`, which is only the limit of the excerpt. `entrance_pieces` is empty.
  Part part;
  /// Kind of each cell of the patch. The cells of the selected element come first. element_id() of a cell is the index
  /// of the first cell of its element.
  std::vector<ExcerptCell> cells;
};

/// Cuts out an element and all cells whose distance from the element is at most `reach_mm` in plan. Sides of the
/// original part within this distance become facets. Cells that reach up to the plane of the entrance face are omitted.
/// \param frame_from_part maps the part frame to the frame of the excerpt
/// \param thickness_mm height of the entrance face in the frame of the excerpt
/// \pre the part is finite and its outline is convex
ElementExcerpt excerpt_around(const Part& part, const PartElement& element, const Eigen::Isometry3d& frame_from_part,
                              double thickness_mm, double reach_mm);

}  // namespace retrace::geometry
