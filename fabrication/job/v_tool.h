#pragma once

// Geometry of V-shaped tools at cube corners: edges of the tool's body, size of the cavity, and whether the tool
// reaches all of it.

#include <array>

#include "core/schema/schema.h"
#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Maximum wedge angle of a tool, in degrees.
inline constexpr double kMaxWedgeDeg = 80.0;

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
/// cube corners, it is twice the edge of the cube.
/// \pre the element is a cube corner
double cavity_edge_mm(const geometry::Element& element);

/// Width that a nose of the tool's radius leaves uncut on either facet along a dihedral edge.
double nose_strip_mm(const Tool& tool);

/// That the tool reaches the apex of a cube corner, and every place of its facets.
/// \param element as it is cut into the blank \pre it is a cube corner
void check_v_tool(const geometry::Element& element, const geometry::AngleErrors& errors, const Tool& tool,
                  const schema::Refuse& refuse);

}  // namespace retrace::fabrication
