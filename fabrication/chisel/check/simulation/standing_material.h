#pragma once

// What stands of the blank at an element while it is cut, in sections across its root or its dihedral edges.

#include <span>
#include <vector>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/chisel/check/simulation/convex_pieces.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/substrate_cells.h"

namespace retrace::fabrication {

/// A plane across an element, in the workpiece frame: origin + u across + v up, where v rises out of the blank. The
/// facets that it crosses meet in its origin.
struct SectionPlane {
  geometry::Vec3 origin_mm = geometry::Vec3::Zero();
  geometry::Vec3 across = geometry::Vec3::UnitX();
  geometry::Vec3 up = geometry::Vec3::UnitZ();
  geometry::Vec3 normal = geometry::Vec3::UnitY();  ///< across x up

  geometry::Vec2 direction(const geometry::Vec3& d) const { return {across.dot(d), up.dot(d)}; }
  geometry::Vec2 point(const geometry::Vec3& p) const { return direction(p - origin_mm); }
  /// How far a point lies beside the plane.
  double beside_mm(const geometry::Vec3& p) const { return normal.dot(p - origin_mm); }
};

/// One section of the blank with what stands in it.
struct StandingSection {
  SectionPlane plane;
  std::vector<ConvexPiece> pieces;  ///< that do not overlap

  /// Takes away what a move of the tool sweeps. \param sides of the swept body \param pose machine_from_workpiece
  /// \return what stood there
  std::vector<ConvexPiece> cut(std::span<const ToolWedge::Side> sides, const RigidMotion& pose);
};

/// The state of an element: to begin with the blank below its face, as far as the element's cuts reach. What was cut
/// before is taken away by cut() of its sections.
class StandingMaterial {
 public:
  /// \param wall_mm by which the tilted ends of the tool's edge may wander: sections keep clear of them
  /// \param tool_width_mm of a chisel: sections stand so densely that each of its passes is crossed by two
  /// \param depth_mm of roughing cuts
  StandingMaterial(const Groove& groove, const BlankFace& face, double wall_mm, double tool_width_mm, double depth_mm);

  std::vector<StandingSection>& sections() { return sections_; }

 private:
  std::vector<StandingSection> sections_;
};

}  // namespace retrace::fabrication
