#pragma once

// Properties of a part that its toolmaker needs: smallest wall, draft, undercuts, optical area and axes of the
// elements.

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/part.h"
#include "requests/inspect.h"
#include "studies/inspect/wall_thickness.h"

namespace retrace::studies {

/// Face of a part with less draft than the limit.
struct SteepFace {
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  geometry::Vec3 centroid_mm = geometry::Vec3::Zero();
  double area_mm2 = 0.0;
  double draft_deg = 0.0;
};

/// Draft of the faces with one role. The draft is the angle between a face and the demoulding direction. It is negative
/// if the face is an undercut.
struct DraftOfFaces {
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  std::int64_t faces = 0;
  double area_mm2 = 0.0;
  double min_draft_deg = 90.0;
  std::int64_t below_limit = 0;  ///< number of faces with less draft than the limit
  std::int64_t undercuts = 0;    ///< number of faces with negative draft
  double undercut_mm2 = 0.0;     ///< area of the faces with negative draft
};

/// Axis of an element, and the normal of the entrance face above it.
struct PinAxis {
  geometry::Polygon outline_mm;  ///< convex hull of the retro facets in plan
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();
  geometry::Vec3 axis = geometry::Vec3::UnitZ();    ///< unit vector from the element towards the light
  geometry::Vec3 normal = geometry::Vec3::UnitZ();  ///< unit normal of the entrance face above the centre

  double angle_deg() const;
  /// Returns the azimuth of the axis relative to the normal, -180 to 180.
  double azimuth_deg() const;
};

struct ToolReport {
  geometry::Vec3 demoulding = geometry::Vec3::UnitZ();  ///< direction in which the part leaves the mould of its back
  WallThickness wall;
  std::vector<DraftOfFaces> draft;     ///< one entry for each role that occurs
  std::vector<SteepFace> steep_faces;  ///< faces with less draft than the limit, steepest first; at most kMaxSteepFaces
  double optical_area_fraction = 0.0;  ///< fraction of the entrance area in plan that is above retro facets
  /// Axes of the elements of which more than half remains, for a part with a curved entrance face; otherwise empty.
  std::vector<PinAxis> pin_axes;

  double min_draft_deg() const;
  std::int64_t below_limit() const;
  std::int64_t undercuts() const;
};

inline constexpr std::size_t kMaxSteepFaces = 10'000;

/// Returns the report on a finite part.
/// \param entrance curved entrance face, or nothing for a plane
/// \pre the part is finite
ToolReport report_tool(const geometry::Part& part, const std::optional<geometry::Entrance>& entrance,
                       const InspectRequest& request);

}  // namespace retrace::studies
