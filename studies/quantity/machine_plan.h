#pragma once

// Plans how the machine of [machining] cuts the prisms of a design. The results are the machining time, the distances
// of the axes from their limits, and the length of cut.

#include <cstddef>
#include <optional>

#include "design/design.h"
#include "studies/quantity/machining.h"

namespace retrace::studies {

/// Results of planning. A value is empty if the machine or the tool cannot cut the part.
struct MachinePlan {
  std::size_t elements = 0;      ///< number of elements that are cut
  std::optional<double> time_s;  ///< machining time of the plan
  /// Smallest distance of the X, Y or Z axis from one of its limits while facets are cut. It is negative if an axis
  /// exceeds a limit.
  std::optional<double> travel_mm;
  std::optional<double> cut_per_element_mm;  ///< path length of the cutting edge in the material, mean per element
};

/// Sets the tool's edge, the tool life and the process of a job to the values of [machining].
void take_machining(const MachiningProcess& process, fabrication::Job& job);

/// Plans all elements of a design, as `retrace job` and `retrace fabricate` do.
/// \pre the process names a machine
/// \throw InputError if no machine can cut the design, or if a file is invalid
MachinePlan plan_on_machine(const design::Design& design, const MachiningProcess& process);

}  // namespace retrace::studies
