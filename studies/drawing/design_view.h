#pragma once

// Mesh of a design for its three-dimensional picture. Large arrays are reduced to a few elements.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/closed_boundary.h"

namespace retrace::studies {

/// Mesh of a part for a picture.
struct DesignView {
  std::string title;
  /// Whole surface. Patches of the back (SurfacePatch) share no vertices with other faces.
  geometry::BoundaryMesh mesh;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< edges between faces of different directions
  std::vector<std::string> remarks;                 ///< differences from the design
  bool has_curved_entrance = false;                 ///< true: the entrance face is not a plane
};

/// Returns the surface of a finite part with its edges.
/// \param entrance_height heights of a curved entrance face; empty for a plane face
DesignView view_of(const geometry::Part& part, const geometry::EntranceHeights& entrance_height = {});

/// Returns the view of a design. Of infinite arrays, and of arrays with very small elements, it shows only a few
/// elements.
/// \throw InputError under the same conditions as part_of_design()
DesignView view_of(const design::Design& design);

/// Returns the view of a design with a curved entrance face. It shows the whole part, without elements that are very
/// small.
/// \param part part of the design
DesignView view_of(const design::Design& design, const geometry::Part& part,
                   const geometry::EntranceHeights& entrance_height);

/// Number of elements that are shown along a side of an array that is too large to be shown as a whole.
inline constexpr double kExcerptElements = 8.0;
/// Maximum number of elements along a side of an array that is shown as a whole.
inline constexpr double kMaxElementsAcross = 60.0;

}  // namespace retrace::studies
