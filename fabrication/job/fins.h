#pragma once

// Material that the cuts of a V-shaped tool leave between them in a cube corner: fins along its dihedral edges and a
// peak in its middle (docs/theory/micro_chiseling.md, section "Fins").

#include <array>
#include <string>

#include "core/angle.h"
#include "fabrication/job/cube_corner.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Width of the strip along a dihedral edge in which remaining material counts for the edge and not for a facet.
inline constexpr double kEdgeStripMm = 1e-3;
/// Distances from a dihedral edge at which the strip is measured, in least increments of the control. Rounding moves a
/// facet by one increment at most.
inline constexpr double kEdgeLineSteps[] = {1.5, 8.0};

/// Returns the maximum distance by which rounding moves a tip along the facet that it cuts.
double rounded_along_mm(double step_mm);
/// Returns the maximum distance by which rounding moves a tip along the normal of the facet that it cuts.
double rounded_across_mm(double step_mm);

/// Angles that the two cuts along a dihedral edge cover, seen along the edge.
struct EdgeCover {
  Angle first;    ///< angle over the first facet up to which the cut along it reaches
  Angle second;   ///< angle over the second facet up to which the cut along it reaches
  Angle between;  ///< angle that the facets include
};

/// Returns the angles at the three dihedral edges. Edge k is located between the facets k and (k + 1) % 3.
/// \param normals unit normals of the facets, out of the material, in counterclockwise order
/// \param spines direction of the tool's spine while it cuts each facet, in the frame of the normals
std::array<EdgeCover, 3> edge_covers(const std::array<geometry::Vec3, 3>& normals,
                                     const std::array<geometry::Vec3, 3>& spines);

/// Returns the directions of the tool's spine while it cuts each facet, in the frame of the element.
/// \param root_tilts angles by which each facet is turned about its normal in the tool's view
std::array<geometry::Vec3, 3> spines_of(const CubeCorner& corner, const Tool& tool,
                                        const std::array<Angle, 3>& root_tilts = {});

/// Returns the height over either facet of the fin that two cuts along a dihedral edge may leave between them because
/// positions are rounded; infinity if the cuts do not overlap.
/// \param step_mm least increment of the control
double rounded_fin_mm(const EdgeCover& cover, double step_mm);

/// Returns the height over any facet of the peak that the cuts of all three facets may leave between them because
/// positions are rounded; infinity if the cuts leave a peak even at exact positions.
/// \param step_mm least increment of the control
double rounded_peak_mm(const std::array<EdgeCover, 3>& covers, double step_mm);

/// Returns the height of the highest fin or peak that may remain in a cube corner.
/// \param step_mm least increment of the control
double highest_fin_mm(const std::array<EdgeCover, 3>& covers, double step_mm);

/// Returns the height for a message: "a fin of 1.234 um". \param fin_mm infinity: up to the face of the blank
std::string fin_text(double fin_mm);

/// Returns the maximum height of a fin that is inside the strip of kEdgeStripMm along the edge, less the distance from
/// the edge of the farthest measuring line.
double max_fin_mm(double step_mm);

}  // namespace retrace::fabrication
