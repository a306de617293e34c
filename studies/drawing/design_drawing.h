#pragma once

// Content of a design's drawing before layout: plan and section with their dimensions and remarks.

#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "design/design.h"
#include "geometry/outline/outline.h"
#include "studies/drawing/part_views.h"

namespace retrace::studies {

/// Dimension of a length in a drawing. `side` determines whether it is horizontal or vertical.
struct Dimension {
  enum class Side { below, left, above, right };
  Side side = Side::below;
  geometry::Vec2 from_mm = geometry::Vec2::Zero();
  geometry::Vec2 to_mm = geometry::Vec2::Zero();
  std::string name;       ///< name of the length, such as "base"
  double value_mm = 0.0;  ///< value in the design; if the design does not give it, value of the part
};

/// Dimension of an angle between two directions in a section.
struct AngleDimension {
  geometry::Vec2 apex_mm = geometry::Vec2::Zero();
  geometry::Vec2 left = geometry::Vec2::UnitX();  ///< unit vectors from the apex along both sides
  geometry::Vec2 right = geometry::Vec2::UnitX();
  double deg = 0.0;
};

/// Zone of a part in the plan.
struct PlanZone {
  std::vector<geometry::Polygon> regions_mm;  ///< regions of the zone; empty if the zone consists of elements
  /// Sides of the regions, clipped to the outline of the part. Empty for a rectangular part, for which the sides of
  /// `regions_mm` are the borders of the zone.
  std::vector<PlanLine> sides_mm = {};
  std::vector<geometry::Vec2> labels_mm;  ///< positions within the zone at which its number is drawn
  std::string description;                ///< such as "1307 full elements and 148 cut, 50.0 % of the area"
};

struct PlanPanel {
  std::string title;
  PlanView view;
  bool omits_faces = false;  ///< true: there are too many faces to draw
  /// Outer border of the part, counter-clockwise. Empty if the part continues in all directions.
  geometry::PolygonLoop outline_mm;
  std::vector<geometry::PolygonLoop> holes_mm = {};  ///< borders of holes, clockwise
  std::optional<geometry::Rectangle> period_mm;
  std::optional<geometry::Rectangle> detail_mm;  ///< window of the detail that another panel shows
  std::optional<double> circle_radius_mm;  ///< radius of the circle around the aperture of the dimensioned element
  geometry::Vec2 circle_mm = geometry::Vec2::Zero();
  std::optional<double> section_y_mm;  ///< y at which the section is cut
  std::vector<Dimension> dimensions;   ///< inner dimensions first
  std::vector<PlanZone> zones = {};    ///< zones of the part, in their order
};

struct SectionPanel {
  std::string title;
  SectionView view;
  bool is_continued = false;          ///< true: the part continues beyond the left and right end
  std::vector<Dimension> dimensions;  ///< dimensions in (x, z)
  std::optional<AngleDimension> angle;
};

/// Plan and section of a part with their texts. The view is from the light: x to the right, y up.
struct DesignDrawing {
  std::string title;
  std::vector<std::string> remarks;
  std::vector<PlanPanel> plan;  ///< the whole part, and a detail if elements are small
  std::optional<SectionPanel> section;
  Warnings warnings;
};

/// Maximum number of elements along x for which a section shows the whole width of a part with a curved entrance face.
inline constexpr double kMaxSectionElements = 80.0;
/// Maximum number of faces that a plan draws individually.
inline constexpr std::size_t kMaxPlanFaces = 16'000;

/// Returns the drawing of a design.
/// \param part part of the design
DesignDrawing draw_design(const design::Design& design, const geometry::Part& part);

/// Returns the drawing of a design with a curved entrance face. The section is near the centre of the part and shows
/// its whole width, unless there are more than kMaxSectionElements elements along x.
/// \param part part of the design
/// \param entrance_height function that returns the heights of the entrance face
DesignDrawing draw_curved_design(const design::Design& design, const geometry::Part& part,
                                 const geometry::EntranceHeights& entrance_height);

/// Returns the drawing of a design without the section.
/// \param part part of the design
DesignDrawing draw_plan(const design::Design& design, const geometry::Part& part);

}  // namespace retrace::studies
