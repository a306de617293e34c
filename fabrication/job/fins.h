#pragma once

// Computes the residual material that a V-shaped tool leaves in a cube corner: fins between the cuts along dihedral
// edges, and a peak above the apex (docs/theory/micro_chiseling.md, section "Fins").

#include <array>
#include <string>

#include "core/angle.h"
#include "fabrication/job/cube_corner.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Width of the strip along a dihedral edge in which residual material is attributed to the edge and not to a facet.
inline constexpr double kEdgeStripMm = 1e-3;
/// Distances from the dihedral edge to the measuring lines, along which material in this strip is measured. The unit is
/// the least increment of the control. All distances are larger than 1, because rounding of positions displaces a facet
/// by at most one increment.
inline constexpr double kEdgeLineSteps[] = {1.5, 8.0};

/// Returns the maximum displacement of the tip, parallel to the facet that it cuts, due to rounded positions.
/// \param step_mm least increment of the control
double rounded_along_mm(double step_mm);
/// Returns the maximum displacement of the tip, normal to the facet that it cuts, due to rounded positions.
/// \param step_mm least increment of the control
double rounded_across_mm(double step_mm);

/// Angular sectors that the two cuts at a dihedral edge remove, seen along the edge. If the two sectors together cover
/// the angle between the facets, no fin remains.
struct EdgeCover {
  Angle first;    ///< sector of the first cut, measured from the first facet
  Angle second;   ///< sector of the second cut, measured from the second facet
  Angle between;  ///< angle between the two facets
};

/// Returns the sectors at the three dihedral edges. Here, edge k is between the facets k and (k + 1) % 3, unlike in
/// CubeCorner::edges.
/// \param normals unit normals of the facets, out of the material, in counter-clockwise order
/// \param spines direction of the tool's spine while the tool cuts each facet, in the frame of the normals. The spine
///        is the edge between the two flanks of the tool
std::array<EdgeCover, 3> edge_covers(const std::array<geometry::Vec3, 3>& normals,
                                     const std::array<geometry::Vec3, 3>& spines);

/// Returns, for each facet, the direction of the tool's spine while the tool cuts this facet, in the frame of the
/// element. The spine is the edge between the two flanks of the tool.
/// \param root_tilts rotation of each facet about its normal, relative to the tool
std::array<geometry::Vec3, 3> spines_of(const CubeCorner& corner, const Tool& tool,
                                        const std::array<Angle, 3>& root_tilts = {});

/// Returns the maximum height of the fin that may remain between two cuts at a dihedral edge due to rounded positions.
/// The height is measured above one of the facets. Returns infinity if the sectors of the cuts do not overlap.
/// \param step_mm least increment of the control
double rounded_fin_mm(const EdgeCover& cover, double step_mm);

/// Returns the maximum height of the peak that may remain between the cuts of all three facets due to rounded
/// positions. The height is measured above one of the facets. Returns infinity if a peak remains even with exact
/// positions.
/// \param step_mm least increment of the control
double rounded_peak_mm(const std::array<EdgeCover, 3>& covers, double step_mm);

/// Returns the maximum height of all fins and peaks that may remain in a cube corner.
/// \param step_mm least increment of the control
double highest_fin_mm(const std::array<EdgeCover, 3>& covers, double step_mm);

/// Returns a description of a fin for messages, such as "a fin of 1.234 um".
/// \param fin_mm height of the fin; infinity means a fin that extends up to the face of the blank
std::string fin_text(double fin_mm);

/// Returns the maximum allowed height of a fin. It is kEdgeStripMm minus the distance of the farthest measuring line
/// from the edge, so that the fin stays inside the strip along the edge.
/// \param step_mm least increment of the control
double max_fin_mm(double step_mm);

}  // namespace retrace::fabrication
