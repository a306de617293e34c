#pragma once

// Determines which facet a move of the tool cuts, and whether the move finishes this facet. The result depends on the
// plane that the edge sweeps, and not on names in the program.

#include <cstddef>
#include <optional>

#include "fabrication/chisel/check/verification_model.h"

namespace retrace::fabrication {

/// Cut along a facet: the edge sweeps a plane that is nearly parallel to the facet.
struct FacetCut {
  std::size_t facet = 0;
  double remaining_mm = 0.0;     ///< minimum distance between the swept plane and the facet
  bool is_by_clearance = false;  ///< true if the clearance face is next to this facet, as in a plunge with a chisel
};

/// Returns the facet along which a move cuts. Returns nothing if the move is along no facet, such as a retract between
/// the two facets.
/// \param back transformation from the machine frame to the workpiece frame
std::optional<FacetCut> facet_cut(const DesignElement& element, const ToolWedge& wedge, const SweptVolume& sweep,
                                  const RigidMotion& back);

/// Returns the normal of the plane that the edge sweeps, in the machine frame. Returns the zero vector if the edge
/// moves along itself and sweeps no plane.
geometry::Vec3 swept_normal(const ToolWedge& wedge, const SweptVolume& sweep);

/// Returns the thickness that finishing removes from every facet, or 0 if the strategy has no finishing cuts.
double finishing_allowance_mm(const VerificationModel& workpiece);

/// Returns true if the swept plane is inside the finishing allowance. Such a cut is a finishing cut, regardless of its
/// name in the program, and must use the feed and depth of finishing.
bool is_finishing(const VerificationModel& workpiece, const FacetCut& cut);

/// Returns the depth of cut that the process specifies for a move, either for roughing or for finishing.
/// \param cut facet along which the move cuts; nullopt if the move is along no facet
double depth_of_cut_mm(const VerificationModel& workpiece, const std::optional<FacetCut>& cut);

}  // namespace retrace::fabrication
