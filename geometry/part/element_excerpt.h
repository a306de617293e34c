#pragma once

// Elements of a part, and the surroundings of one element as a part of their own, in a rotated frame.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::geometry {

/// One element of a finite part: a placement of a patch and the cells of the element in this patch.
struct PartElement {
  std::uint32_t placement = 0;
  std::vector<std::uint32_t> cells;  ///< indices into SurfacePatch::cells
  /// Point of the part frame where the largest number of retro facets meet: the apex of a cube corner, the middle of
  /// the roof edge of a prism. If there are several such points, it is their mean.
  Vec3 apex_mm = Vec3::Zero();
  Vec3 lower_mm = Vec3::Zero();  ///< bounding box in the part frame
  Vec3 upper_mm = Vec3::Zero();
  std::vector<Vec3> corners_mm;  ///< all corners of the element's facets, in the part frame
};

/// Returns all elements of a finite part, whole and cut. An element has at least one retro facet.
std::vector<PartElement> part_elements(const Part& part);

/// An element and its surroundings, in a frame of their own.
struct ElementExcerpt {
  /// Facets of the element and of its surroundings. The entrance face is the plane z = `thickness_mm` of the frame. The
  /// real part continues beyond `outline`, which has no physical meaning. `entrance_pieces` is empty.
  Part part;
  /// For each cell of the patch: true if it belongs to an element, false for land and for the sides of the real part.
  /// The cells of the element itself come first. All of them have the element_id() 0.
  std::vector<bool> is_element;
  bool has_sides = false;  ///< true if sides of the real part are in the excerpt
};

/// Returns an element and all cells whose distance from it in plan is at most `reach_mm`. The sides of the real part
/// near the element become facets. Facets that reach the plane of the entrance face are omitted.
/// \param frame_from_part maps the part frame to the frame of the excerpt
/// \param thickness_mm height of the entrance face in the frame of the excerpt
/// \pre the part is finite and its outline is convex
ElementExcerpt excerpt_around(const Part& part, const PartElement& element, const Eigen::Isometry3d& frame_from_part,
                              double thickness_mm, double reach_mm);

}  // namespace retrace::geometry
