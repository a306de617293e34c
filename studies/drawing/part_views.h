#pragma once

// Projections of a part for drawings: the faces of its back in plan, and its outline in a section.

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::studies {

using PlanLine = std::pair<geometry::Vec2, geometry::Vec2>;

/// A face of the back surface in plan.
struct PlanFace {
  geometry::Polygon outline_mm;
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  double azimuth_deg = 0.0;  ///< towards which it looks, out of the part; 0 to below 360
};

/// What of a part's back surface lies in a window, seen from the light.
struct PlanView {
  geometry::Rectangle window_mm;
  std::vector<PlanFace> faces;
  std::vector<PlanLine> rims_mm;   ///< where elements end
  std::vector<PlanLine> roots_mm;  ///< where faces of one cell meet
};

/// \pre of an infinite part the window lies within the periods that its surface covers
PlanView plan_view(const geometry::Part& part, const geometry::Rectangle& window_mm);

/// About how many faces a plan of the window has: those of the placements that reach into it.
std::size_t faces_near(const geometry::Part& part, const geometry::Rectangle& window_mm);

/// A part cut by a plane across y.
struct SectionView {
  double y_mm = 0.0;
  double x_from_mm = 0.0;
  double x_to_mm = 0.0;
  std::vector<geometry::Vec2> outline_mm;  ///< (x, z), closed; the last two corners lie on the entrance face
};

/// \return none where nothing is cut, or where the back folds under itself (meshes)
std::optional<SectionView> section_view(const geometry::Part& part, double y_mm, double x_from_mm, double x_to_mm);

}  // namespace retrace::studies
