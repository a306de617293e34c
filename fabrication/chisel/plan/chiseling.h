#pragma once

// Plans diamond micro chiseling of cube corners (docs/theory/micro_chiseling.md). A V-shaped tool is tilted by B until
// its leading edge is in the facet. The tool moves down one dihedral edge of the facet to the apex and up the other
// dihedral edge of the facet.

#include <array>
#include <string>

#include "fabrication/chisel/plan/routines.h"
#include "fabrication/chisel/plan/section.h"

namespace retrace::fabrication {

/// Returns the thickness that roughing leaves on all facets for the finishing layers.
double chiseling_allowance_mm(const Job& job);
/// Returns the total thickness, in mm, that roughing removes from an element of a zone, measured along the normal of
/// each facet.
/// \param stock_mm height of the blank's face above the rims
/// \throw InputError if finishing would have nothing to remove
double chiseling_across_mm(const Job& job, std::size_t zone, double stock_mm);
/// Returns the number of roughing layers. The layers are nested cube corners with a distance of `roughing_depth_um`
/// between their facets.
/// \param stock_mm height of the blank's face above the rims
int chiseling_layers(const Job& job, std::size_t zone = 0, double stock_mm = 0.0);

/// Returns the rotary pose in which a facet is cut. Of all equivalent angles C, it uses the one that is closest to
/// `previous_c_deg` within the limits of the axis.
/// \throw InputError naming axis and limits if the machine cannot reach the pose
CuttingPose chiseling_pose(const Job& job, const Machine& machine, const FacetChoice& facet, double previous_c_deg,
                           const ElementPose& stance = {});

/// Checks the tool in the three poses of elements with equal orientation. B and C align the tool with a facet, but
/// cannot rotate it about the facet's normal. The tool must not touch the other facets and must leave no high fins. Its
/// cutting edges must extend above the blank's face.
/// \param poses poses of the three facets
/// \throw InputError naming element, tilt and limit
void check_v_in_poses(const Job& job, const Machine& machine, const std::array<CuttingPose, 3>& poses,
                      const ElementPose& stance);

/// Returns the subroutine that cuts one facet of one layer. The tool moves down the first dihedral edge of the facet to
/// the apex of the layer, and up the second dihedral edge of the facet.
/// \param left_mm thickness of the material that the layer leaves on all facets
Routine chiseling_routine(const Job& job, const Machine& machine, const CuttingPose& pose, double left_mm,
                          double feed_mm_per_min);

/// Returns a description of the elements of a zone, for the header of a program.
/// \pre the job has zones
std::string zone_description(const Job& job, std::size_t zone);

/// Rounds axis positions to whole increments. If `along` is 0, each position is rounded to the nearest increment.
/// Otherwise, one of the eight neighbouring grid points is returned: the point with the smallest error along the
/// direction `along`.
LinearPosition rounded_words(const geometry::Vec3& words_mm, const geometry::Vec3& along, Nanometres step_nm);

}  // namespace retrace::fabrication
