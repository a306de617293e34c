#pragma once

// Represents the remaining stock of an element during cutting, in cross-sections of its root or of its dihedral edges.

#include <span>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/simulation/convex_polygons.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/substrate_cells.h"

namespace retrace::fabrication {

/// Cross-section plane of an element, in the workpiece frame. Its points are origin + u * across + v * up, where `up`
/// points out of the blank. The two intersected facets meet in the origin.
struct SectionPlane {
  geometry::Vec3 origin_mm = geometry::Vec3::Zero();
  geometry::Vec3 across = geometry::Vec3::UnitX();
  geometry::Vec3 up = geometry::Vec3::UnitZ();
  geometry::Vec3 normal = geometry::Vec3::UnitY();  ///< unit normal: cross product of `across` and `up`

  geometry::Vec2 direction(const geometry::Vec3& d) const { return {across.dot(d), up.dot(d)}; }
  geometry::Vec2 point(const geometry::Vec3& p) const { return direction(p - origin_mm); }
  /// Returns the signed distance of a point from the plane.
  double signed_distance_mm(const geometry::Vec3& p) const { return normal.dot(p - origin_mm); }
};

/// Cross-section of the blank and its remaining stock.
struct StockSection {
  SectionPlane plane;
  std::vector<ConvexPolygon> polygons;  ///< remaining stock as polygons that do not overlap

  /// Removes the material that a move of the tool sweeps.
  /// \param sides sides of the swept body
  /// \param pose machine_from_workpiece
  /// \return the removed material
  std::vector<ConvexPolygon> cut(std::span<const ToolWedge::Side> sides, const RigidMotion& pose);
};

/// Remaining stock of an element in several cross-sections. Initially, it is the whole blank below its face. The
/// function cut() of each section removes material.
class RemainingStock {
 public:
  /// \param wall_mm maximum displacement of the ends of a tilted edge; sections keep this distance from the walls
  /// \param tool_width_mm width of a chisel; each of its passes is crossed by at least two sections
  /// \param depth_mm depth of cut of roughing
  RemainingStock(const Cavity& groove, const BlankFace& face, double wall_mm, double tool_width_mm, double depth_mm);

  std::vector<StockSection>& sections() { return sections_; }

 private:
  std::vector<StockSection> sections_;
};

}  // namespace retrace::fabrication
