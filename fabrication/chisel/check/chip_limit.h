#pragma once

// How thick chips get that a process's depth of cut leaves, line by line (docs/theory/verification.md).

#include <array>
#include <limits>

#include "core/angle.h"
#include "fabrication/chisel/check/facet_cut.h"

namespace retrace::fabrication {

/// Maximum allowed chip thickness of a cut, measured perpendicular to the plane that the cutting edge sweeps.
class ChipLimit {
 public:
  /// Of a move in one pose. \param cut the facet along which it cuts \param back from the machine's frame
  ChipLimit(const Workpiece3d& workpiece, std::size_t element, const std::optional<FacetCut>& cut,
            const ToolWedge& wedge, const RigidMotion& back);

  /// \param from_tip_mm of the line, along the path from where the tip goes deepest; of a V along the section
  /// \param beside_mm of that place from the section in which the line lies
  double at(double from_tip_mm, double beside_mm) const;
  /// Distances from the tip, in mm, at which the limit has a kink or a jump.
  const std::array<double, 2>& bends_mm() const { return bends_mm_; }
  double depth_mm() const { return depth_mm_; }

 private:
  enum class Kind { plunge, plough, between, v_shaped };

  double plunge_at(double from_tip_mm) const;

  Kind kind_ = Kind::between;
  double depth_mm_ = 0.0;    ///< of the process
  double slack_mm_ = 0.0;    ///< tolerance, and what tilted edges make unavoidable
  double rake_slope_ = 0.0;  ///< of the rake face against the plunged facet
  Angle apex_;
  double share_ = 0.0;     ///< limit divided by depth of cut, for kinds with a constant ratio
  double reach_mm_ = 0.0;  ///< V-shaped tool: distance from the neighbouring dihedral edge up to which `share_` applies
  std::array<double, 2> bends_mm_{};
};

}  // namespace retrace::fabrication
