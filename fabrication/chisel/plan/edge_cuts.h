#pragma once

// The cuts of a plan that make facets, as straight moves of the edge in the words of its programs.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/edge_cut.h"

namespace retrace::fabrication {

/// A cut along a facet of an element.
struct FacetEdgeCut {
  std::size_t element = 0;
  std::size_t facet = 0;  ///< from 0
  std::size_t stage = 0;  ///< index in Plan::stages
  bool is_ploughed = false;
  bool ends_at_root = false;  ///< the tip, at the root or the apex
  EdgeCut cut;
};

/// The last cut along a facet in every visit of an element, in the order in which they are made. A V makes two in a
/// visit, down one dihedral edge and up the other; a routine that ploughs makes one of either facet.
/// \param elements those alone, ascending; empty: all
std::vector<FacetEdgeCut> facet_edge_cuts(const Job& job, const Plan& plan,
                                          const std::vector<std::size_t>& elements = {});

}  // namespace retrace::fabrication
