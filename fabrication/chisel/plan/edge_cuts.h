#pragma once

// Lists the cuts of a plan that produce facets. Each cut is a straight move of the edge, given by axis positions.

#include <cstddef>
#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/edge_cut.h"

namespace retrace::fabrication {

/// Cut along a facet of an element.
struct FacetEdgeCut {
  std::size_t element = 0;
  std::size_t facet = 0;  ///< index of the facet, from 0
  std::size_t stage = 0;  ///< index in Plan::stages
  bool is_ploughed = false;
  bool ends_at_root = false;  ///< true if the tip is at the root or the apex at the end of the cut
  EdgeCut cut;
};

/// Returns the cuts that produce facets, in the order of cutting. For every visit of an element and each facet that the
/// visit cuts, only the last cut along the facet is returned. A V-shaped tool makes two cuts along one facet: down one
/// dihedral edge and up another edge. A routine with ploughing makes one cut along each of the two facets.
/// \param elements indices of the elements to include, ascending; empty: all elements
std::vector<FacetEdgeCut> facet_edge_cuts(const Job& job, const Plan& plan,
                                          const std::vector<std::size_t>& elements = {});

}  // namespace retrace::fabrication
