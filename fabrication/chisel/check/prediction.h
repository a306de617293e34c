#pragma once

// Predicts form errors that the axes of a machine cannot avoid. The prediction does not depend on any program. The
// checks subtract the predicted errors from the measured errors before they compare the result with the tolerance.

#include <array>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Surface that one ploughing pass of a tilted edge leaves on a facet (docs/theory/verification.md). Positions along
/// the root are signed along the root direction of the groove.
struct PloughedFloor {
  double slope = 0.0;          ///< rise of the surface along the root, in mm per mm
  double half_width_mm = 0.0;  ///< half of the width of the pass, along the root
  double drift = 0.0;          ///< displacement of the pass along the root, in mm per mm of distance from the root
  /// Distance between two points of the root. The first point is the centre of the ploughed surface. The second point
  /// is the intersection of the root with the plane in which the centre of the edge moves. It is not 0 because the
  /// centre of a tilted edge is above the facet.
  double shift_mm = 0.0;
};

/// Unavoidable errors of all elements of one orientation on one machine. They are computed from the poses that the
/// machine requires, and not from the poses in the program (docs/theory/verification.md).
struct Prediction {
  std::vector<PlungePose> poses;  ///< poses of the rotary axes, one for the cuts of each facet (two or three facets)
  std::array<PloughedFloor, 2> ploughed;  ///< surfaces of facets 1 and 2, each ploughed in the pose of the other facet
  /// Normal, in the machine frame, of the plane in which the tool moves when only Y and Z move.
  geometry::Vec3 pass_normal = geometry::Vec3::UnitX();
  /// Maximum width, along a facet, of the strip at the root that a tilted edge leaves uncut. Prisms only: a V-shaped
  /// tool moves along the dihedral edges of a cube corner and leaves no strip.
  double root_mm = 0.0;
  std::array<double, 2> root_of_mm{};  ///< width of this strip on facet 1 and on facet 2
  /// Maximum depth by which an end of the edge, or the tool above it, cuts into the wall at an end of the element.
  double wall_mm = 0.0;
  double fin_mm =
      0.0;  ///< cube corners: maximum height of the fin that rounded positions leave between the cuts of two facets
  double step_mm = 0.0;  ///< least increment of the control
};

/// Predicts the unavoidable errors of an element.
/// \throw InputError if the machine cannot plunge a facet
Prediction predict(const Machine& machine, const Cavity& groove, const ToolWedge& wedge);

}  // namespace retrace::fabrication
