#pragma once

// Which facet a move of the tool cuts, and whether it finishes it: told from what the edge sweeps, not from names.

#include <cstddef>
#include <optional>

#include "fabrication/chisel/check/workpiece.h"

namespace retrace::fabrication {

/// A move whose edge sweeps a plane along one of an element's facets.
struct FacetCut {
  std::size_t facet = 0;
  double left_mm = 0.0;          ///< that the swept plane leaves over the facet, where it comes nearest
  bool is_by_clearance = false;  ///< the clearance face looks at the facet: a chisel plunges along it
};

/// Nothing for a move along none of them, such as a retract between both. \param back from the machine's frame
std::optional<FacetCut> facet_cut(const Groove& groove, const ToolWedge& wedge, const SweptVolume& sweep,
                                  const RigidMotion& back);

/// Normal of the plane that the edge sweeps, in the frame of the machine; zero where it sweeps none.
geometry::Vec3 swept_normal(const ToolWedge& wedge, const SweptVolume& sweep);

/// What finishing takes off every facet of a job, 0 where its strategy has no finishing cuts.
double finishing_allowance_mm(const Workpiece3d& workpiece);

/// Whether the swept plane lies within the finishing allowance of the design: such a cut finishes, however the program
/// calls it, and is to be made at finishing feed and depth.
bool is_finishing(const Workpiece3d& workpiece, const FacetCut& cut);

/// The process's depth of cut for that move, of roughing or of finishing. \param cut nothing: along no facet
double depth_of_cut_mm(const Workpiece3d& workpiece, const std::optional<FacetCut>& cut);

}  // namespace retrace::fabrication
