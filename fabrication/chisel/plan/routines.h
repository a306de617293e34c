#pragma once

// Subroutines that cut one prism: plunges along one facet, ploughs along the other, layer by layer.

#include "fabrication/chisel/plan/section.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// A subroutine with the place where it starts, relative to the root's middle or the apex.
struct Routine {
  Subroutine subroutine;
  Place start = Place::Zero();
};

/// How many cuts a facet takes (roughing; layers of a bidirectional strategy). Unidirectional cuts are slices of
/// `roughing_depth_um` parallel to facet 1: ceil((base / sqrt 2 - allowance) / DOC) at 90 degrees. Bidirectional layers
/// are nested V shells that take as much off either facet.
/// \param stock_mm by which the blank stands over the rims
int cuts_per_facet(const Job& job, double stock_mm = 0.0);

/// What roughing takes off a facet, along its normal; of a bidirectional strategy half of it.
/// \throw InputError naming the key if finishing leaves nothing
double roughing_across_mm(const Job& job, double stock_mm);

/// By how much a first cut may take more than planned, or less, in some section across its edge. Ends of a tilted edge
/// stand two lifts apart over the blank's face, those of the plunge along the other facet as well; positions are whole
/// steps in Y and Z of either.
inline double edge_dip_mm(const Section& section) {
  return 4.0 * section.lift_mm + 2.0 * static_cast<double>(section.step_nm) / kNanometresPerMm;
}

/// What stays over the last cut, along the facet's normal, when cut `cut` of `cuts` is made: whole depths; where the
/// first that takes anything would be thinner than the least chip it shares with the next.
/// \param across_mm that all take \param share of its depth that the first one takes where it is thickest
/// \param dip_mm edge_dip_mm()
/// \throw InputError naming the key if it is thinner even so
double left_of_roughing_mm(const Job& job, double across_mm, int cut, int cuts, double share = 1.0,
                           double dip_mm = 0.0);

/// That finishing leaves something to roughing. \param left_mm of a facet's depth \throw InputError naming the key
void check_allowance(const Job& job, double left_mm);

/// So many cuts as a whole number, at least 1. \throw InputError at process.roughing_depth_um for more than 100,000
int whole_cuts(const Job& job, double cuts);

/// What roughing leaves on both facets for the finishing cuts.
double finishing_allowance_mm(const Job& job);

/// Length of a plough that just frees the chip: the slice's thickness along the floor and the edge's radius.
double shortest_plough_mm(const Job& job, const Section& section);

/// All cuts of an element by plunging and ploughing, cut i of N ending (N - i) DOC short of the last wall. Every root
/// lies on the floor. What stays on wall and floor is the finishing allowance.
Routine unidirectional_routine(const Job& job, const Section& section);

/// One plunge along the wall that leaves `left_mm` on wall and floor, with the retract along the bisector.
Routine plunge_routine(const Job& job, const Section& section, double left_mm, double feed_mm_per_min);

/// Side-by-side passes that an element of `width_mm` takes, as offsets of their middles along the root.
std::vector<double> pass_offsets_mm(double width_mm, double tool_width_mm);

}  // namespace retrace::fabrication
