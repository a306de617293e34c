#pragma once

// What a straight-edged chisel leaves of a design of cube corners, as a design that can be traced.

#include <string>

#include "fabrication/chisel/check/chisel_reach.h"
#include "studies/design/design.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::studies {

/// What a chisel with a straight edge makes of cube corners (single-point inverted cutting of them).
struct ReachablePart {
  fabrication::ChiselReach reach;
  std::int64_t elements = 0;
  std::string design;  ///< file (retrace.design/1) of the part that it can make, for `retrace rre`
  std::string facets;  ///< the table of planes that goes with it
};

/// \param facets_file name of that table
/// \throw InputError for prisms, for `dmc`, and for tools that leave nothing to trace
ReachablePart reachable_part(const Design& design, const JobRequest& request, const std::string& facets_file);

/// Share of the facets that the request's chisel reaches; nothing for one that has no share.
double reachable_share(const geometry::Element& element, double tool_width_mm);

/// retrace.reach/1, and the same for people.
std::string reach_json(const ReachablePart& part, const JobRequest& request);
std::string reach_table(const ReachablePart& part);

}  // namespace retrace::studies
