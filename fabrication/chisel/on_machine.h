#pragma once

// What a job asks of the machine that cuts it, for those who plan it and those who judge its programs.

#include <array>
#include <string>

#include "core/angle.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Minimum cosine of the angle between a facet and the plane that the edge sweeps along it, about cos 10 degrees. A cut
/// at a larger angle belongs to no facet: axes of machines are off by minutes of arc, and facets are at least 60
/// degrees apart.
inline constexpr double kAlongFacet = 0.985;

/// Whether a job's strategy has finishing cuts.
bool has_finishing_cuts(const Job& job);

/// \throw InputError naming file, line and key: another axis must tilt, a feed is above those of the machine's axes,
/// finishing cuts would be deeper than roughing, or a depth of cut is little beside the increments of the control
void check_on_machine(const Job& job, const Machine& machine);

/// Checks that a V-shaped tool leaves no fin that is higher than the strip that is measured along edges, as the control
/// rounds positions. \pre the tool fits the cube corner at exact positions
/// \param root_tilts angles by which each facet is turned about its normal in the tool's view
/// \param who beginning of the message
/// \throw InputError with the key to change: a larger wedge angle, or smaller increments of the control if no wedge
/// angle is large enough
void check_fins(const Job& job, const Machine& machine, const CubeCorner& corner,
                const std::array<Angle, 3>& root_tilts = {}, const std::string& who = "");

}  // namespace retrace::fabrication
