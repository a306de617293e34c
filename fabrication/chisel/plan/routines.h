#pragma once

// Generates subroutines that cut one prism: plunges along one facet and ploughs along the other facet, layer by layer.

#include "fabrication/chisel/plan/section.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Subroutine and its start point, relative to the centre of the root or to the apex.
struct Routine {
  Subroutine subroutine;
  LinearPosition start = LinearPosition::Zero();
};

/// Returns the number of roughing cuts per facet, or the number of layers of a bidirectional strategy. Unidirectional
/// cuts are slices of thickness `roughing_depth_um` (DOC) parallel to facet 1. At an apex angle of 90 degrees, the
/// number of slices is ceil((base / sqrt 2 - allowance) / DOC). Bidirectional layers are nested V shapes with equal
/// thickness on both facets.
/// \param stock_mm height of the blank's face above the rims
int cuts_per_facet(const Job& job, double stock_mm = 0.0);

/// Returns the thickness that roughing removes from a facet, along its normal. For a bidirectional strategy, returns
/// half of this thickness, because each layer removes material from both facets.
/// \throw InputError naming the key if nothing remains for roughing
double roughing_across_mm(const Job& job, double stock_mm);

/// Returns the maximum difference, in mm, between the actual and the planned chip thickness of the first cut of a
/// facet. The difference has two causes. The ends of a tilted edge differ in height by twice `lift_mm`, both in this
/// plunge and in the plunge along the other facet. In addition, the Y and Z positions of both plunges are rounded to
/// whole increments.
inline double edge_dip_mm(const Section& section) {
  return 4.0 * section.lift_mm + 2.0 * static_cast<double>(section.step_nm) / kNanometresPerMm;
}

/// Returns the thickness, along the facet's normal, that roughing must still remove after cut `cut` of `cuts`. The
/// first cut removes the remainder of the thickness, and all later cuts have the full depth. If the first chip would be
/// thinner than the minimum chip, the thickness of the first two cuts is divided equally between them.
/// \param across_mm total thickness that all cuts remove
/// \param thickness_ratio maximum chip thickness of the first cut, divided by its depth
/// \param dip_mm edge_dip_mm()
/// \throw InputError naming the key if the first chip is still too thin
double roughing_remainder_mm(const Job& job, double across_mm, int cut, int cuts, double thickness_ratio = 1.0,
                             double dip_mm = 0.0);

/// Checks that roughing has material to remove in addition to the finishing allowance.
/// \param left_mm thickness that remains for roughing
/// \throw InputError naming the key if the thickness is not positive
void check_allowance(const Job& job, double left_mm);

/// Rounds a number of cuts up to a whole number, at least 1.
/// \throw InputError at process.roughing_depth_um for more than 100,000 cuts
int whole_cuts(const Job& job, double cuts);

/// Returns the thickness that roughing leaves on both facets for the finishing cuts.
double finishing_allowance_mm(const Job& job);

/// Returns the minimum length of a plough that separates the chip: the thickness of the slice along the floor plus the
/// radius of the edge.
double shortest_plough_mm(const Job& job, const Section& section);

/// Returns the subroutine with all cuts of an element by plunging along the wall (one facet) and ploughing along the
/// floor (the other facet). The distance of cut i of N from the last wall is (N - i) times the depth of cut. The root
/// of every cut is on the floor. The finishing allowance remains on wall and floor.
Routine unidirectional_routine(const Job& job, const Section& section);

/// Returns the subroutine with one plunge along the wall (the plunged facet) and a retract along the bisector of wall
/// and floor (the other facet).
/// \param left_mm thickness that remains on wall and floor
Routine plunge_routine(const Job& job, const Section& section, double left_mm, double feed_mm_per_min);

/// Returns the parallel passes for an element of width `width_mm`, as offsets of their centres along the root.
std::vector<double> pass_offsets_mm(double width_mm, double tool_width_mm);

}  // namespace retrace::fabrication
