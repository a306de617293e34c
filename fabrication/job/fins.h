#pragma once

// Residual material between the cuts of a V-shaped tool in a cube corner: fins along the dihedral edges, and a peak
// over the apex (docs/theory/micro_chiseling.md, section "Fins").

#include <array>
#include <string>

#include "core/angle.h"
#include "fabrication/job/cube_corner.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Width of the strip along a dihedral edge in which residual material is attributed to the edge and not to a facet.
inline constexpr double kEdgeStripMm = 1e-3;
/// Distances from a dihedral edge of the lines on which the strip is measured, in least increments of the control. The
/// rounding of positions shifts a facet by at most one increment.
inline constexpr double kEdgeLineSteps[] = {1.5, 8.0};

/// Returns the maximum displacement of a tip parallel to the facet that it cuts, caused by the rounding of positions.
double rounded_along_mm(double step_mm);
/// Returns the maximum displacement of a tip normal to the facet that it cuts, caused by the rounding of positions.
double rounded_across_mm(double step_mm);

/// Angular sectors that the two cuts along a dihedral edge remove, seen along the edge. If they overlap, no fin
/// remains.
struct EdgeCover {
  Angle first;    ///< sector of the first cut, measured from the first facet
  Angle second;   ///< sector of the second cut, measured from the second facet
  Angle between;  ///< angle between the two facets
};

/// Returns the sectors at the three dihedral edges. Edge k is located between the facets k and (k + 1) % 3.
/// \param normals unit normals of the facets, out of the material, in counterclockwise order
/// \param spines directions of the tool's spine, in which its two flanks meet, while it cuts each facet; in the frame
///        of the normals
std::array<EdgeCover, 3> edge_covers(const std::array<geometry::Vec3, 3>& normals,
                                     const std::array<geometry::Vec3, 3>& spines);

/// Returns the directions of the tool's spine while it cuts each facet, in the frame of the element.
/// \param root_tilts rotations of each facet about its normal, relative to the tool
std::array<geometry::Vec3, 3> spines_of(const CubeCorner& corner, const Tool& tool,
                                        const std::array<Angle, 3>& root_tilts = {});

/// Returns the maximum height, above either facet, of the fin that the rounding of positions may leave between two cuts
/// along a dihedral edge. Returns infinity if the cuts do not overlap.
/// \param step_mm least increment of the control
double rounded_fin_mm(const EdgeCover& cover, double step_mm);

/// Returns the maximum height, above any facet, of the peak that the rounding of positions may leave between the cuts
/// of all three facets. Returns infinity if a peak remains even without rounding.
/// \param step_mm least increment of the control
double rounded_peak_mm(const std::array<EdgeCover, 3>& covers, double step_mm);

/// Returns the height of the highest fin or peak that may remain in a cube corner.
/// \param step_mm least increment of the control
double highest_fin_mm(const std::array<EdgeCover, 3>& covers, double step_mm);

/// Returns the height of a fin as text for a message, such as "a fin of 1.234 um".
/// \param fin_mm infinity: the fin extends up to the face of the blank
std::string fin_text(double fin_mm);

/// Returns the maximum allowed height of a fin: kEdgeStripMm less the distance of the farthest measuring line from the
/// edge. Such a fin remains within the strip along the edge.
double max_fin_mm(double step_mm);

}  // namespace retrace::fabrication
