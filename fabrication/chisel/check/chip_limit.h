#pragma once

// Computes the maximum allowed chip thickness from the depth of cut of the process. The limit is different for each
// measuring line of a cross-section (docs/theory/verification.md).

#include <array>

#include "core/angle.h"
#include "fabrication/chisel/check/facet_cut.h"

namespace retrace::fabrication {

/// Maximum allowed chip thickness of a cut, measured perpendicular to the plane that the cutting edge sweeps.
class ChipLimit {
 public:
  /// Computes the limit for a move in one pose of the rotary axes.
  /// \param cut facet along which the move cuts; empty if the move cuts along no facet
  /// \param back transformation from the machine frame to the workpiece frame
  ChipLimit(const VerificationModel& workpiece, std::size_t element, const std::optional<FacetCut>& cut,
            const ToolWedge& wedge, const RigidMotion& back);

  /// Returns the maximum chip thickness on one measuring line of a cross-section, in mm.
  /// \param from_tip_mm distance, along the path of the tool, from the deepest position of the tip to the measuring
  ///        line. For a V-shaped tool, the distance is measured in the cross-section
  /// \param from_end_mm distance from the nearer end of the tip's path to the cross-section that contains the measuring
  ///        line
  double at(double from_tip_mm, double from_end_mm) const;
  /// Returns the distances from the tip, in mm, at which the limit has a kink or a jump.
  const std::array<double, 2>& kinks_mm() const { return kinks_mm_; }
  double depth_mm() const { return depth_mm_; }

 private:
  enum class Kind { plunge, plough, between, v_shaped };

  void limit_chisel(const VerificationModel& workpiece, std::size_t element, const PrismGroove& groove,
                    const std::optional<FacetCut>& cut);
  /// \param spine direction of the tool's spine, in which its clearance face and its other flank intersect
  void limit_v_tool(const CubeCavity& cavity, const FacetCut& cut, const geometry::Vec3& spine);
  double plunge_at(double from_tip_mm) const;

  Kind kind_ = Kind::between;
  double depth_mm_ = 0.0;    ///< depth of cut of the process
  double slack_mm_ = 0.0;    ///< tolerance, plus the residual material that a tilted edge unavoidably leaves
  double rake_slope_ = 0.0;  ///< tangent of the angle between the rake face and the plunged facet
  Angle apex_;
  double ratio_ = 0.0;     ///< limit divided by depth of cut, for kinds of cuts that have a constant ratio
  double reach_mm_ = 0.0;  ///< V-shaped tool: distance from the neighbouring dihedral edge up to which `ratio_` applies
  std::array<double, 2> kinks_mm_{};
};

}  // namespace retrace::fabrication
