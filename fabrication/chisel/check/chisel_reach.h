#pragma once

// Computes which part of a cube corner a chisel with a straight edge can cut. The results are the fraction of the
// facets that is cut, and the height of the core that remains above the apex.

#include <array>

#include "core/error.h"
#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Plane that bounds the material that a chisel leaves in front of a facet of a cube corner. It contains the deepest
/// position of the edge and is parallel to the rake face.
struct ChiselCap {
  geometry::Vec3 normal = geometry::Vec3::UnitZ();   ///< unit normal, out of the material
  geometry::Vec3 point_mm = geometry::Vec3::Zero();  ///< point of the plane, relative to the apex
};

/// Part of a cube corner that can be cut by plunging along its facets with a horizontal edge and infinitely close
/// passes (docs/theory/micro_chiseling.md). Facet k is between the dihedral edges at 120 k and 120 (k + 1) degrees.
struct ChiselReach {
  double facet_area_mm2 = 0.0;  ///< area of one facet
  /// Fraction of the area of a facet that is cut. The remainder is a triangle at the apex, whose height is half of the
  /// width of the tool.
  double fraction = 0.0;
  double core_mm = 0.0;           ///< height of the remaining core above the apex
  std::array<ChiselCap, 3> caps;  ///< planes in the part frame; the remaining material is below all three planes
  double cut_fraction = 0.0;      ///< same as `fraction`, computed by simulating 1201 plunges on each facet
  double cut_core_mm = 0.0;       ///< same as `core_mm`, computed by this simulation
};

/// Returns the area of one facet of a cube corner.
double facet_area_mm2(const geometry::Element& element);

/// Computes the part of a cube corner that a chisel can cut.
/// \pre the element is a cube corner and the tool is a chisel
ChiselReach chisel_reach(const geometry::Element& element, const Tool& tool);

/// Checks that the remaining core above the apex is below the blank's face, and that no material remains along the
/// dihedral edges.
/// \throw InputError at `width` or `wedge`
void check_chisel_reach(const geometry::Element& element, const Tool& tool, const InputLocation& width,
                        const InputLocation& wedge);

}  // namespace retrace::fabrication
