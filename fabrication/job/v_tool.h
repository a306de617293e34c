#pragma once

// Geometry of V-shaped tools in cube corners: edges of the tool, size of the cavity, and the check that the tool can
// cut the whole cavity.

#include "core/schema/schema.h"
#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Maximum wedge angle of a tool, in degrees.
inline constexpr double kMaxWedgeDeg = 80.0;

/// Unit vectors along the three edges of a V-shaped tool, upwards from its tip, while it cuts a facet. Their components
/// are along the facet's first dihedral edge, its second dihedral edge and its outward normal. The leading edge is in
/// the facet. The clearance face is inclined to the facet about the leading edge (docs/theory/micro_chiseling.md).
struct VToolEdges {
  geometry::Vec3 leading = geometry::Vec3::UnitY();   ///< cutting edge, on the side of the second dihedral edge
  geometry::Vec3 trailing = geometry::Vec3::UnitX();  ///< second edge of the clearance face
  geometry::Vec3 spine = geometry::Vec3::UnitZ();     ///< edge between the two flanks
};
VToolEdges v_tool_edges(const Tool& tool);

/// Returns the length of the dihedral edges from the apex to the blank's face, without angle errors. For hexagonal cube
/// corners, it is twice the edge length of the cube.
/// \pre the element is a cube corner
double cavity_edge_mm(const geometry::Element& element);

/// Returns the width of the strip that remains uncut on each facet along a dihedral edge, because the nose of the tool
/// is rounded.
double nose_strip_mm(const Tool& tool);

/// Checks that the tool can cut a cube corner up to its apex, and every point of its facets. Calls `refuse` for each
/// key that does not fit.
/// \param element element as it is cut into the blank
/// \pre the element is a cube corner
void check_v_tool(const geometry::Element& element, const geometry::AngleErrors& errors, const Tool& tool,
                  const schema::Refuse& refuse);

}  // namespace retrace::fabrication
