#pragma once

// Errors that the axes of a machine cannot avoid, worked out apart from any program and taken off what is judged.

#include <array>
#include <vector>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Surface that one ploughing pass of a tilted edge leaves on a facet (docs/theory/verification.md). Positions along
/// the root are signed along the root direction of the groove.
struct PloughedFloor {
  double slope = 0.0;          ///< rise of the surface along the root, in mm per mm
  double half_width_mm = 0.0;  ///< half of the width of the pass, along the root
  double drift = 0.0;          ///< movement of the pass along the root, in mm, for each mm up the facet
  /// Distance, along the root, from the plane of the pass at the facet to the center of the edge.
  double shift_mm = 0.0;
};

/// What a machine's axes make unavoidable for the elements of one orientation, from the poses that this machine needs -
/// not from those of the program (docs/theory/verification.md).
struct Prediction {
  std::vector<PlungePose> poses;          ///< poses in which the two or three facets are cut
  std::array<PloughedFloor, 2> ploughed;  ///< surfaces of facets 1 and 2, each ploughed in the pose of the other facet
  /// Normal, in the machine frame, of the plane in which the tool moves when only Y and Z move.
  geometry::Vec3 pass_normal = geometry::Vec3::UnitX();
  /// Of prisms. A V follows the dihedral edges themselves and its planes hold the facets: it leaves nothing.
  double root_mm = 0.0;                ///< by which the ends of the tilted edge stay up a facet at the root at most
  std::array<double, 2> root_of_mm{};  ///< the same, up each facet
  double wall_mm = 0.0;  ///< maximum depth by which an end of the edge, or the tool above it, cuts into a wall
  double fin_mm =
      0.0;  ///< cube corners: height of the fin between the cuts of two facets that the rounding of positions may leave
  double step_mm = 0.0;  ///< least increment of the control
};

/// \throw InputError if the machine cannot plunge a facet
Prediction predict(const Machine& machine, const Groove& groove, const ToolWedge& wedge);

}  // namespace retrace::fabrication
