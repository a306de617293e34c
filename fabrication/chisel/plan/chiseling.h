#pragma once

// Planning of diamond micro chiseling of cube corners (docs/theory/micro_chiseling.md): a V-shaped tool, tilted by B
// until its leading edge lies in the facet, goes down one dihedral edge to the apex and up the other one.

#include <array>
#include <string>
#include <vector>

#include "fabrication/chisel/plan/routines.h"
#include "fabrication/chisel/plan/section.h"

namespace retrace::fabrication {

/// What layers of roughing leave on all facets for the finishing layers.
double chiseling_allowance_mm(const Job& job);
/// Returns the total thickness, in mm, that roughing removes from an element of a zone, measured along the normal of
/// each facet.
/// \param stock_mm height of the blank's face above the rims
/// \throw InputError if finishing would have nothing to remove
double chiseling_across_mm(const Job& job, std::size_t zone, double stock_mm);
/// Roughing layers: nested cube corners, each `roughing_depth_um` further along the normals of all three facets.
/// \param stock_mm by which the blank stands over the rims
int chiseling_layers(const Job& job, std::size_t zone = 0, double stock_mm = 0.0);

/// The pose, with C as near to `previous_c_deg` as its limits let it. \throw InputError naming axis and limits if the
/// machine cannot take it
CuttingPose chiseling_pose(const Job& job, const Machine& machine, const FacetChoice& facet, double previous_c_deg,
                           const Stance& stance = {});

/// That the tool, which B and C lay on the facets but cannot turn in them, keeps clear of the other facets, leaves no
/// fin between two and comes out of the blank. \param poses of the three facets of elements that stand alike
/// \throw InputError naming element, tilt and limit
void check_v_in_poses(const Job& job, const Machine& machine, const std::array<CuttingPose, 3>& poses,
                      const Stance& stance);

/// Down one edge and up the other of a cube corner that leaves `left_mm` on all facets.
Routine chiseling_routine(const Job& job, const Machine& machine, const CuttingPose& pose, double left_mm,
                          double feed_mm_per_min);

/// Returns a description of the elements of a zone, for the header of a program.
/// \pre the job has zones
std::string zone_description(const Job& job, std::size_t zone);

/// Words in whole steps: each rounded by itself where `along` is 0, else that of the eight neighbours with the least
/// error along it.
Place rounded_words(const geometry::Vec3& words_mm, const geometry::Vec3& along, Nanometres step_nm);

}  // namespace retrace::fabrication
