#pragma once

// V-shaped tools with a rounded nose: their body, and the strip and ridge that they leave along dihedral edges.

#include <span>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// The V-shaped tool with its nose: the sharp wedge of v_tool_wedge() within planes along its spine that touch the arc
/// between its two edges. They go round the arc, so that the body is larger by 0.06 % of the radius at most.
/// \pre edge_radius_um > 0
ToolWedge nosed_wedge(const Tool& tool, const Machine& machine);

/// What a nose leaves along the dihedral edges of a cube corner, at most.
struct NoseResidue {
  double strip_mm = 0.0;  ///< width of either facet beside an edge that no cut comes over
  /// From an edge, along the middle between its two facets, to where the cuts begin: the ridge that stays between the
  /// flanks of the two cuts.
  double ridge_mm = 0.0;
};

/// Found along lines, by cutting with the nosed wedge in the moves of the programs. Searched within 40 radii.
/// \param sweeps of the element \param poses machine_from_workpiece for each Sweep::pose
NoseResidue nose_residue(const Groove& cavity, double radius_mm, std::span<const SweptVolume> sweeps,
                         std::span<const RigidMotion> poses, const ToolWedge& nosed);

}  // namespace retrace::fabrication
