#pragma once

// Projections of a part for drawings: the faces of its back in plan, and its outline in a section.

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"

namespace retrace::studies {

using PlanLine = std::pair<geometry::Vec2, geometry::Vec2>;

/// Face of the back surface in plan.
struct PlanFace {
  geometry::Polygon outline_mm;
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  double azimuth_deg = 0.0;              ///< azimuth of the outward normal of the face; 0 to below 360
  std::optional<std::size_t> zone = {};  ///< zone of the part that the face belongs to, from 0
};

/// Back surface of a part within a window, as seen from the light.
struct PlanView {
  geometry::Rectangle window_mm;
  std::vector<PlanFace> faces;
  std::vector<PlanLine> rims_mm;   ///< borders of elements
  std::vector<PlanLine> roots_mm;  ///< lines between faces of one cell
};

/// Returns the plan of a window.
/// \pre for an infinite part, the window is within the periods that its surface covers
PlanView plan_view(const geometry::Part& part, const geometry::Rectangle& window_mm);

/// Returns the approximate number of faces in a plan of the window. It counts all faces of each patch of the back
/// surface that overlaps with the window.
std::size_t faces_near(const geometry::Part& part, const geometry::Rectangle& window_mm);

/// Section of a part with a plane of constant y.
struct SectionView {
  double y_mm = 0.0;
  double x_from_mm = 0.0;
  double x_to_mm = 0.0;
  std::vector<geometry::Vec2> outline_mm;  ///< (x, z), closed; see `entrance_corners`
  std::size_t entrance_corners = 2;        ///< number of corners on the entrance face; the last ones of `outline_mm`

  /// Returns the corners on the entrance face, from right to left.
  std::vector<geometry::Vec2> entrance_mm() const;
};

/// Returns the section of a part.
/// \param entrance_height function that returns the heights of a curved entrance face; empty for a plane face
/// \return nothing if the plane does not hit the part, or if the back has overhangs (meshes)
std::optional<SectionView> section_view(const geometry::Part& part, double y_mm, double x_from_mm, double x_to_mm,
                                        const geometry::EntranceHeights& entrance_height = {});

}  // namespace retrace::studies
