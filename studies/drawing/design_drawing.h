#pragma once

// The content of a design's drawing: plan and section with their dimensions and remarks, before anything is put on
// paper.

#include <optional>
#include <string>
#include <vector>

#include "studies/design/design.h"
#include "studies/drawing/part_views.h"

namespace retrace::studies {

/// A length that is written on a drawing: across or along it, whichever its side says.
struct Dimension {
  enum class Side { below, left, above, right };
  Side side = Side::below;
  geometry::Vec2 from_mm = geometry::Vec2::Zero();
  geometry::Vec2 to_mm = geometry::Vec2::Zero();
  std::string name;       ///< what it is: "base"
  double value_mm = 0.0;  ///< as the design says it, or of the part where the design leaves it open
};

/// An angle between two directions in a section.
struct AngleDimension {
  geometry::Vec2 apex_mm = geometry::Vec2::Zero();
  geometry::Vec2 left = geometry::Vec2::UnitX();  ///< unit vectors from the apex
  geometry::Vec2 right = geometry::Vec2::UnitX();
  double deg = 0.0;
};

struct PlanPanel {
  std::string title;
  PlanView view;
  bool faces_are_left_out = false;  ///< there are too many
  geometry::Polygon outline_mm;     ///< of the part; empty where it goes on all round
  std::optional<geometry::Rectangle> period_mm;
  std::optional<geometry::Rectangle> detail_mm;  ///< that another panel shows
  std::optional<double> circle_radius_mm;        ///< round the aperture of the element that is measured
  geometry::Vec2 circle_mm = geometry::Vec2::Zero();
  std::optional<double> section_y_mm;  ///< where the section is cut
  std::vector<Dimension> dimensions;   ///< inner ones first
};

struct SectionPanel {
  std::string title;
  SectionView view;
  double thickness_mm = 0.0;
  bool goes_on = false;               ///< beyond its left and right ends
  std::vector<Dimension> dimensions;  ///< in (x, z)
  std::optional<AngleDimension> angle;
};

/// Plan and section of a part with what is to be written on them. Seen from the light: x to the right, y up.
struct DesignDrawing {
  std::string title;
  std::vector<std::string> remarks;
  std::vector<PlanPanel> plan;  ///< the whole, and a detail where elements are small in it
  std::optional<SectionPanel> section;
  std::vector<std::string> warnings;
};

/// Most faces that a plan draws one by one.
inline constexpr std::size_t kMostPlanFaces = 16'000;

/// \param part of that design
DesignDrawing draw_design(const Design& design, const geometry::Part& part);

}  // namespace retrace::studies
