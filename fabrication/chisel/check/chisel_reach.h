#pragma once

// How much of a cube corner a chisel with a straight edge can cut: the share it reaches and the core it leaves over the
// apex.

#include <array>

#include "core/error.h"
#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// What a chisel with a straight edge leaves in front of a facet of a cube corner: a plane through the deepest place of
/// its edge, along its rake face.
struct ChiselCap {
  geometry::Vec3 normal = geometry::Vec3::UnitZ();   ///< out of the material, of length 1
  geometry::Vec3 point_mm = geometry::Vec3::Zero();  ///< on it, from the apex
};

/// The part of a cube corner that plunges along its facets reach, with the edge level and passes infinitely close
/// (docs/theory/micro_chiseling.md). Facet k lies between the dihedral edges at 120 k and 120 (k + 1) degrees.
struct ChiselReach {
  double facet_area_mm2 = 0.0;    ///< of one facet
  double share = 0.0;             ///< of it that is reached: all but a triangle at the apex as high as half the edge
  double core_mm = 0.0;           ///< height over the apex of what is left there
  std::array<ChiselCap, 3> caps;  ///< in the part's frame; the material ends below all three
  /// The same found by cutting with the tool's planes: 1201 plunges on either facet.
  double cut_share = 0.0;
  double cut_core_mm = 0.0;
};

/// \pre the element is a cube corner, the tool a chisel
ChiselReach chisel_reach(const geometry::Element& element, const Tool& tool);

/// That what the chisel leaves over the apex stays below the blank's face, and nothing along the dihedral edges.
/// \throw InputError at `width` or `wedge`
void check_chisel_reach(const geometry::Element& element, const Tool& tool, const InputLocation& width,
                        const InputLocation& wedge);

}  // namespace retrace::fabrication
