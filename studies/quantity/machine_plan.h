#pragma once

// Plans how the machine of [machining] cuts the prisms of a candidate. The plan gives machining time, travel of the
// axes and length of cut.

#include <cstddef>
#include <optional>

#include "design/design.h"
#include "studies/quantity/machining.h"

namespace retrace::studies {

/// Results of a plan for a machine. A value is missing if the machine or the tool cannot cut the part.
struct MachinePlan {
  std::size_t elements = 0;      ///< number of elements that are cut
  std::optional<double> time_s;  ///< machining time of the plan
  /// Smallest distance between X, Y or Z and a limit of this axis while facets are cut. The distance is negative if the
  /// axis exceeds the limit.
  std::optional<double> travel_mm;
  std::optional<double> cut_per_element_mm;  ///< path length of the cutting edge in the material, for one element
};

/// Replaces the tool's edge, the tool life and the process of a job by the values of [machining].
void take_machining(const MachiningProcess& process, fabrication::Job& job);

/// Plans all elements of a design like `retrace job` and `retrace fabricate`.
/// \pre the process names a machine
/// \throw InputError for a design that cannot be cut on any machine, or if a file is invalid
MachinePlan plan_on_machine(const design::Design& design, const MachiningProcess& process);

}  // namespace retrace::studies
