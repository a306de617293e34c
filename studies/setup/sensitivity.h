#pragma once

// Computes how errors of the set-up displace facets, change chip thicknesses and displace the ends of cuts at roots.

#include <cstddef>
#include <string>
#include <vector>

#include "fabrication/chisel/plan/edge_cuts.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/setup.h"

namespace retrace::studies {

/// Kind of facet. All facets with the same number in elements with the same orientation are of one kind.
struct FacetKind {
  std::size_t facet = 0;  ///< index of the facet, from 0
  bool rotated = false;   ///< true: facets of rotated elements

  std::string name() const;  ///< name such as "facet 1" or "facet 1 of rotated elements"
  bool operator==(const FacetKind&) const = default;
};

/// Displacement and tilt of the facets of one kind, per um or arcsec of a set-up quantity. The values are those of the
/// facet whose plane moves farthest.
struct FacetEffect {
  /// Displacement of the facet's center along its outward normal. It is positive if material remains.
  double distance_nm = 0.0;
  double up_arcmin = 0.0;  ///< tilt, positive if the facet rises away from the root, which narrows the groove
  /// Tilt, positive if the facet rises along the root (cube corners: along the facet's horizontal line).
  double along_arcmin = 0.0;
  double farthest_nm = 0.0;  ///< displacement of the corner that moves farthest, with its sign
};

struct Sensitivity {
  const fabrication::SetupQuantity* quantity = nullptr;
  std::vector<FacetEffect> facets;  ///< effects on the kinds of facets in Sensitivities::kinds, in this order
  double chip_nm = 0.0;             ///< maximum change of the chip thickness of a cut
  double root_residual_nm = 0.0;    ///< maximum distance by which an end of the cutting edge stops above another facet
  double root_cut_nm = 0.0;         ///< maximum depth by which an end of the cutting edge goes below another facet
  /// Maximum displacement, along the root, of the ends of the cutting edge and of points of the tool above these ends.
  /// Such a displacement moves the tool into the walls at the ends of the groove.
  double wall_nm = 0.0;

  double farthest_nm() const;  ///< maximum absolute displacement over all facets
  double largest_nm() const;   ///< maximum effect on facets, chips and roots; walls are not included
};

struct Sensitivities {
  std::vector<FacetKind> kinds;
  std::vector<Sensitivity> rows;  ///< sorted by size, the largest first
};

/// Returns the elements on which errors of the set-up have the largest effect: for each orientation, the element in the
/// center and the outermost elements. The indices are ascending.
std::vector<std::size_t> outermost_elements(const std::vector<fabrication::CutElement>& elements);

/// Computes the sensitivities from the cuts of the outermost elements.
/// \param plan plan of the job on the machine
Sensitivities sensitivities(const fabrication::Job& job, const fabrication::Machine& machine,
                            const fabrication::Plan& plan);

}  // namespace retrace::studies
