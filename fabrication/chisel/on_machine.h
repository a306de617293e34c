#pragma once

// Checks whether a machine can cut a job. The planner and the verification of programs both use these checks.

#include <array>
#include <string>

#include "core/angle.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Minimum cosine of the angle between a facet and the plane that the edge sweeps in a cut along this facet. It is
/// about the cosine of 10 degrees. The exact value is not critical: errors of machine axes are only arc minutes, and
/// facets are at least 60 degrees apart.
inline constexpr double kMinCosAlongFacet = 0.985;

/// Checks that a machine can cut a job.
/// \throw InputError naming file, line and key if the wrong axis tilts, or a feed exceeds the limits of the axes. It is
///        also thrown if finishing cuts are deeper than roughing cuts, or if a depth of cut is too small compared to
///        the increments of the control
void check_on_machine(const Job& job, const Machine& machine);

/// Checks the height of the fins (thin ridges) that a V-shaped tool leaves along dihedral edges when the control rounds
/// positions. The maximum height is max_fin_mm().
/// \pre the tool fits the cube corner if positions are exact
/// \param root_tilts rotation of each facet about its normal, relative to the tool
/// \param who beginning of the error message
/// \throw InputError at tool.wedge_deg if a larger wedge angle is sufficient. Otherwise, it is thrown at `machine` if
///        smaller increments are sufficient, or at tool.nose_angle_deg
void check_fins(const Job& job, const Machine& machine, const CubeCorner& corner,
                const std::array<Angle, 3>& root_tilts = {}, const std::string& who = "");

}  // namespace retrace::fabrication
