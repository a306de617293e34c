#pragma once

// Geometry of V-shaped tools at cube corners: edges of the tool's body, size of the cavity, and whether the tool
// reaches all of it.

#include <array>

#include "core/angle.h"
#include "core/schema/schema.h"
#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// The three edges of a V-shaped tool's body, upwards from its tip, of length 1, as components along a facet's first
/// dihedral edge, its second one and its outward normal. The tool stands as it cuts: its leading edge lies in the facet
/// and the clearance face turns away from it about that edge (docs/theory/micro_chiseling.md).
struct VToolEdges {
  geometry::Vec3 leading = geometry::Vec3::UnitY();   ///< cutting edge, on the side of the second dihedral edge
  geometry::Vec3 trailing = geometry::Vec3::UnitX();  ///< the other edge of the clearance face
  geometry::Vec3 spine = geometry::Vec3::UnitZ();     ///< where the two flanks meet
};
VToolEdges v_tool_edges(const Tool& tool);

/// Returns the length of the dihedral edges from the apex to the blank's face, without errors of angle. For hexagonal
/// cube corners this is twice the cube's edge. \pre the element is a cube corner
double cavity_edge_mm(const geometry::Element& element);

/// Width that a nose of the tool's radius leaves uncut on either facet along a dihedral edge.
double nose_strip_mm(const Tool& tool);

/// Width of the strip on either side of a dihedral edge. Remaining material in this strip is reported for the edge and
/// not for a facet.
inline constexpr double kEdgeStripMm = 1e-3;
/// Distances from a dihedral edge at which the material in the strip is measured, in least increments of the control.
/// They are larger than 1 because rounding moves a facet by up to one increment.
inline constexpr double kEdgeLineSteps[] = {1.5, 8.0};

/// Returns the maximum height of the fin that the cuts of two facets may leave at their dihedral edge because positions
/// are rounded (docs/theory/micro_chiseling.md, section "Fins"). The height is measured normal to either facet; it is
/// infinity if the cuts do not overlap.
/// \param first angle at the dihedral edge between the first facet and the upper boundary of its cut
/// \param second angle at the dihedral edge between the second facet and the upper boundary of its cut
/// \param between angle between the facets
/// \param step_mm least increment of the control
double rounded_fin_mm(Angle first, Angle second, Angle between, double step_mm);

/// Returns the maximum height of a fin that is inside the strip of kEdgeStripMm along the edge, less the distance from
/// the edge of the farthest measuring line.
double max_fin_mm(double step_mm);

/// Returns the maximum height of the fin for an ideally aligned tool. \param error largest error of angle of the
/// element
double rounded_fin_mm(const Tool& tool, Angle error, double step_mm);

/// That the tool reaches the apex of a cube corner, and every place of its facets.
/// \param element as it is cut into the blank \pre it is a cube corner
void check_v_tool(const geometry::Element& element, const geometry::AngleErrors& errors, const Tool& tool,
                  const schema::Refuse& refuse);

}  // namespace retrace::fabrication
