#pragma once

// Model of V-shaped tools with a rounded nose, and the strips and ridges that they leave along dihedral edges.

#include <span>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Returns the V-shaped tool with a rounded nose. The arc between its two edges is approximated by planes that are
/// tangent to the arc and parallel to the spine. The body is larger than the real nose by at most 0.06 % of the radius.
/// \pre edge_radius_um > 0
ToolWedge nosed_wedge(const Tool& tool, const Machine& machine);

/// Maximum residual material that a rounded nose leaves along the dihedral edges of a cube corner.
struct NoseResidue {
  double strip_mm = 0.0;  ///< width of the uncut strip of a facet next to a dihedral edge
  /// Height of the ridge between the flanks of the two cuts, measured from the dihedral edge along the bisector of the
  /// two facets.
  double ridge_mm = 0.0;
};

/// Measures the residual material along lines, by simulating the programs with the rounded tool. The search is limited
/// to 40 nose radii from the dihedral edges.
/// \param sweeps swept volumes of the element
/// \param poses machine_from_workpiece for each SweptVolume::pose
NoseResidue nose_residue(const CubeCavity& cavity, double radius_mm, std::span<const SweptVolume> sweeps,
                         std::span<const RigidMotion> poses, const ToolWedge& nosed);

}  // namespace retrace::fabrication
