#pragma once

// What a unit of every quantity of the set-up does to the facets of a job, to its chips and to its roots.

#include <cstddef>
#include <string>
#include <vector>

#include "fabrication/chisel/plan/edge_cuts.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/setup.h"

namespace retrace::studies {

/// Facets of one number of elements that stand alike, the same one of each.
struct FacetKind {
  std::size_t facet = 0;  ///< from 0
  bool rotated = false;   ///< of elements that are rotated

  std::string name() const;  ///< "facet 1", "facet 1 of turned elements"
  bool operator==(const FacetKind&) const = default;
};

/// What a um or an arcsec does to the facets of a kind: to the one whose plane moves farthest.
struct FacetEffect {
  double distance_nm = 0.0;   ///< of its middle, along its outward normal: positive leaves material
  double up_arcmin = 0.0;     ///< positive where it rises away from the root, which closes the groove
  double along_arcmin = 0.0;  ///< positive where it rises along the root, of a cube corner along its level line
  double farthest_nm = 0.0;   ///< of its corners: the largest distance, signed
};

struct Sensitivity {
  const fabrication::SetupQuantity* quantity = nullptr;
  std::vector<FacetEffect> facets;  ///< by Sensitivities::kinds
  double chip_nm = 0.0;       ///< by which the chip of a cut changes most, from how the material was left before it
  double root_left_nm = 0.0;  ///< at most, that an end of the edge stops short of another facet
  double root_cut_nm = 0.0;   ///< at most, that it goes below one
  /// Maximum displacement, along the root, of an end of the edge or of the tool above this end.
  double wall_nm = 0.0;

  double farthest_nm() const;  ///< of all facets, unsigned
  double largest_nm() const;   ///< maximum change of facets, chips and roots; walls are excluded
};

struct Sensitivities {
  std::vector<FacetKind> kinds;
  std::vector<Sensitivity> rows;  ///< the largest first
};

/// Elements in which a set-up shows most: of those that stand alike the one in the middle and those farthest out.
/// Ascending.
std::vector<std::size_t> outermost_elements(const std::vector<fabrication::CutElement>& elements);

/// Of the elements that are outermost. \param plan of the job on the machine
Sensitivities sensitivities(const fabrication::Job& job, const fabrication::Machine& machine,
                            const fabrication::Plan& plan);

}  // namespace retrace::studies
